// Choosing the OpenGL library, with an environment in which Mesa does not crash.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "render/gl-context.h"

#include <cstdlib>
#include <initializer_list>
#include <mutex>

#include "base/error.h"
#include "render/floating-point-guard.h"

namespace tw {

namespace {

bool is_one_of(const char* value, std::initializer_list<const char*> wanted) {
  for (const char* w : wanted)
    if (value && std::string(value) == w) return true;
  return false;
}

// Mesa 22.3 dies of SIGSEGV with drivers that need a display (zink) or do not exist, and with
// vectors of 512 bits.
void make_environment_safe() {
  if (!is_one_of(std::getenv("GALLIUM_DRIVER"), {"llvmpipe", "softpipe"}))
    setenv("GALLIUM_DRIVER", "llvmpipe", 1);
  if (!is_one_of(std::getenv("LP_NATIVE_VECTOR_WIDTH"), {"128", "256"}))
    unsetenv("LP_NATIVE_VECTOR_WIDTH");
  // no files in the user's home behind their back
  setenv("MESA_SHADER_CACHE_DISABLE", "true", 0);
  // EGL would pick a graphics card, whose pixels differ
  setenv("LIBGL_ALWAYS_SOFTWARE", "1", 1);
}

}  // namespace

std::string GlContext::description() const {
  const GLubyte* renderer = gl_.GetString(GL_RENDERER);
  return backend_ + ", " + (renderer ? reinterpret_cast<const char*>(renderer) : "unknown");
}

const GlLibrary& gl_library() {
  static std::mutex mutex;
  static const GlLibrary* library = nullptr;
  const std::lock_guard lock(mutex);
  if (library) return *library;

  const FloatingPointGuard guard;
  make_environment_safe();
  std::string osmesa_reason = "OSMesa is not wanted", egl_reason = "EGL is not wanted";
  const char* wanted = std::getenv("TIMEWARP_OPENGL");
  TW_REQUIRE(!wanted || is_one_of(wanted, {"", "egl", "osmesa"}),
             "TIMEWARP_OPENGL is " + std::string(wanted) + "; expected osmesa or egl, or nothing");
  if (!is_one_of(wanted, {"egl"})) library = open_osmesa_library(osmesa_reason);
  if (!library && !is_one_of(wanted, {"osmesa"})) library = open_egl_library(egl_reason);
  TW_REQUIRE(library,
             "cannot draw: " + osmesa_reason + "; " + egl_reason +
                 "; on Debian: apt-get install libosmesa6, or libegl1 where there is none");
  return *library;
}

}  // namespace tw
