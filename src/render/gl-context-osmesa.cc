// OpenGL by OSMesa: contexts without any window system.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include <array>

#include "base/error.h"
#include "render/gl-context.h"
#include "render/shared-library.h"

namespace tw {

namespace {

// from GL/osmesa.h, whose package is not needed to build
constexpr int osmesa_format = 0x22;
constexpr int osmesa_rgba = 0x1908;
constexpr int osmesa_profile = 0x33;
constexpr int osmesa_core_profile = 0x34;
constexpr int osmesa_context_major_version = 0x36;
constexpr int osmesa_context_minor_version = 0x37;

struct OsmesaApi {
  void* (*create_context_attribs)(const int* attributes, void* share);
  void (*destroy_context)(void* context);
  unsigned char (*make_current)(void* context, void* buffer, unsigned type, int width, int height);
  void* (*get_proc_address)(const char* name);
};

class OsmesaContext final : public GlContext {
 public:
  explicit OsmesaContext(const OsmesaApi& api) : GlContext("OSMesa"), api_(api) {
    const int attributes[] = {osmesa_format,
                              osmesa_rgba,
                              osmesa_profile,
                              osmesa_core_profile,
                              osmesa_context_major_version,
                              3,
                              osmesa_context_minor_version,
                              3,
                              0};
    context_ = api_.create_context_attribs(attributes, nullptr);
    TW_REQUIRE(context_, "cannot draw: OSMesa gives no OpenGL 3.3 context");
    // the default framebuffer is never drawn to, but must be there
    const bool current =
        api_.make_current(context_, dummy_.data(), GL_UNSIGNED_BYTE, dummy_side, dummy_side);
    try {
      TW_REQUIRE(current, "cannot draw: OSMesa cannot make its context current");
      gl_ = load_gl_api(api_.get_proc_address);
    } catch (...) {
      api_.destroy_context(context_);
      throw;
    }
  }
  ~OsmesaContext() override {
    api_.make_current(nullptr, nullptr, 0, 0, 0);
    api_.destroy_context(context_);
  }

 private:
  static constexpr int dummy_side = 4;
  OsmesaApi api_;
  void* context_ = nullptr;
  std::array<unsigned char, 4 * dummy_side * dummy_side> dummy_{};
};

class OsmesaLibrary final : public GlLibrary {
 public:
  explicit OsmesaLibrary(const OsmesaApi& api) : api_(api) {}
  std::unique_ptr<GlContext> open_context() const override {
    return std::make_unique<OsmesaContext>(api_);
  }

 private:
  OsmesaApi api_;
};

}  // namespace

const GlLibrary* open_osmesa_library(std::string& reason) {
  // never closed: its threads and LLVM's exit handlers outlive any context
  void* library = open_shared_library("libOSMesa.so.8", reason);
  if (!library) return nullptr;
  OsmesaApi api{};
  if (!find_symbol(library, "OSMesaCreateContextAttribs", api.create_context_attribs) ||
      !find_symbol(library, "OSMesaDestroyContext", api.destroy_context) ||
      !find_symbol(library, "OSMesaMakeCurrent", api.make_current) ||
      !find_symbol(library, "OSMesaGetProcAddress", api.get_proc_address)) {
    reason = "libOSMesa.so.8 lacks functions that drawing needs";
    return nullptr;
  }
  static const OsmesaLibrary osmesa(api);
  return &osmesa;
}

}  // namespace tw
