// OpenGL by surfaceless EGL: the way to llvmpipe where OSMesa is gone (Mesa 25.1 and later).
// Source: EGL_MESA_platform_surfaceless, EGL_KHR_no_config_context, EGL_KHR_surfaceless_context.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <cstdint>

#include "base/error.h"
#include "render/gl-context.h"
#include "render/shared-library.h"

namespace tw {

namespace {

// from EGL/egl.h and EGL/eglext.h, whose package is not needed to build
constexpr unsigned egl_platform_surfaceless = 0x31DD;
constexpr unsigned egl_opengl_api = 0x30A2;
constexpr std::int32_t egl_none = 0x3038;
constexpr std::int32_t egl_context_major_version = 0x3098;
constexpr std::int32_t egl_context_minor_version = 0x30FB;
constexpr std::int32_t egl_context_profile_mask = 0x30FD;
constexpr std::int32_t egl_core_profile = 1;

struct EglApi {
  void* (*get_platform_display)(unsigned platform, void* native, const std::intptr_t* attributes);
  unsigned (*initialize)(void* display, std::int32_t* major, std::int32_t* minor);
  unsigned (*bind_api)(unsigned api);
  void* (*create_context)(void* display, void* config, void* share, const std::int32_t* attributes);
  unsigned (*destroy_context)(void* display, void* context);
  unsigned (*make_current)(void* display, void* draw, void* read, void* context);
  void* (*get_proc_address)(const char* name);
};

class EglContext final : public GlContext {
 public:
  EglContext(const EglApi& api, void* display) : GlContext("EGL"), api_(api), display_(display) {
    const std::int32_t attributes[] = {
        egl_context_major_version, 3,       egl_context_minor_version, 3, egl_context_profile_mask,
        egl_core_profile,          egl_none};
    api_.bind_api(egl_opengl_api);
    context_ = api_.create_context(display_, nullptr, nullptr, attributes);
    TW_REQUIRE(context_, "cannot draw: EGL gives no OpenGL 3.3 context");
    const bool current = api_.make_current(display_, nullptr, nullptr, context_);
    try {
      TW_REQUIRE(current, "cannot draw: EGL cannot make its context current");
      gl_ = load_gl_api(api_.get_proc_address);
    } catch (...) {
      api_.destroy_context(display_, context_);
      throw;
    }
  }
  ~EglContext() override {
    api_.make_current(display_, nullptr, nullptr, nullptr);
    api_.destroy_context(display_, context_);
  }

 private:
  EglApi api_;
  void* display_;
  void* context_ = nullptr;
};

class EglLibrary final : public GlLibrary {
 public:
  EglLibrary(const EglApi& api, void* display) : api_(api), display_(display) {}
  std::unique_ptr<GlContext> open_context() const override {
    return std::make_unique<EglContext>(api_, display_);
  }

 private:
  EglApi api_;
  void* display_;
};

}  // namespace

const GlLibrary* open_egl_library(std::string& reason) {
  void* library = open_shared_library("libEGL.so.1", reason);
  if (!library) return nullptr;
  EglApi api{};
  if (!find_symbol(library, "eglGetPlatformDisplay", api.get_platform_display) ||
      !find_symbol(library, "eglInitialize", api.initialize) ||
      !find_symbol(library, "eglBindAPI", api.bind_api) ||
      !find_symbol(library, "eglCreateContext", api.create_context) ||
      !find_symbol(library, "eglDestroyContext", api.destroy_context) ||
      !find_symbol(library, "eglMakeCurrent", api.make_current) ||
      !find_symbol(library, "eglGetProcAddress", api.get_proc_address)) {
    reason = "libEGL.so.1 lacks functions that drawing needs";
    return nullptr;
  }
  void* display = api.get_platform_display(egl_platform_surfaceless, nullptr, nullptr);
  if (!display || !api.initialize(display, nullptr, nullptr)) {
    reason = "libEGL.so.1 cannot draw without a display";
    return nullptr;
  }
  static const EglLibrary egl(api, display);
  return &egl;
}

}  // namespace tw
