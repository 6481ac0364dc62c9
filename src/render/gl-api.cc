// Filling the table of OpenGL functions.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "render/gl-api.h"

#include <cstring>
#include <string>

#include "base/error.h"

namespace tw {

namespace {

bool has_extension(const GlApi& gl, const char* wanted) {
  GLint count = 0;
  gl.GetIntegerv(GL_NUM_EXTENSIONS, &count);
  for (GLint i = 0; i < count; ++i) {
    const GLubyte* name = gl.GetStringi(GL_EXTENSIONS, static_cast<GLuint>(i));
    if (name && std::strcmp(reinterpret_cast<const char*>(name), wanted) == 0) return true;
  }
  return false;
}

}  // namespace

GlApi load_gl_api(const GlLoader& load) {
  GlApi gl;
#define TW_GL_LOAD(name, NAME)                                     \
  gl.name = reinterpret_cast<PFNGL##NAME##PROC>(load("gl" #name)); \
  TW_REQUIRE(gl.name, "cannot draw: the OpenGL library has no function gl" #name);
  TW_GL_FUNCTIONS(TW_GL_LOAD)
#undef TW_GL_LOAD

  GLint major = 0, minor = 0;
  gl.GetIntegerv(GL_MAJOR_VERSION, &major);
  gl.GetIntegerv(GL_MINOR_VERSION, &minor);
  const int version = 10 * major + minor;
  TW_REQUIRE(version >= 33, "cannot draw: OpenGL is version " + std::to_string(major) + "." +
                                std::to_string(minor) + "; needed is 3.3 or later");
  TW_REQUIRE(version >= 45 || has_extension(gl, "GL_ARB_clip_control"),
             "cannot draw: OpenGL lacks GL_ARB_clip_control, which the depth buffer needs");
  return gl;
}

}  // namespace tw
