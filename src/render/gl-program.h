// Shader programs and framebuffers.  What they make on the GL side lives as long as the context.
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <string>

#include "math/vec.h"
#include "render/gl-api.h"

namespace tw {

using Matrix4f = Eigen::Matrix4f;

// A compiled and linked program.  Its inputs are set by name after use(); names that the compiler
// dropped are ignored.
class GlProgram {
 public:
  // The preamble goes before the fragment source.  A source that does not compile is our bug.
  GlProgram(const GlApi& gl, const char* vertex_source, const char* fragment_source,
            const std::string& fragment_preamble = "");
  void use() const { gl_->UseProgram(program_); }
  void set(const char* name, int value) const { gl_->Uniform1i(find(name), value); }
  void set(const char* name, double value) const {
    gl_->Uniform1f(find(name), static_cast<float>(value));
  }
  void set(const char* name, double x, double y) const {
    gl_->Uniform2f(find(name), static_cast<float>(x), static_cast<float>(y));
  }
  void set(const char* name, const Vec3& value) const;
  void set(const char* name, const Matrix4f& value) const {
    gl_->UniformMatrix4fv(find(name), 1, GL_FALSE, value.data());
  }

 private:
  GLint find(const char* name) const { return gl_->GetUniformLocation(program_, name); }
  const GlApi* gl_;
  GLuint program_;
};

// An unfiltered texture without contents.
GLuint make_texture(const GlApi& gl, GLint format, int width, int height);

// A framebuffer on the textures (0: none), up to two colours.  Raises UserError when the driver
// cannot have it, which for large pictures it says by its status only, never by an error.
GLuint make_framebuffer(const GlApi& gl, GLuint color0, GLuint color1, GLuint depth);

}  // namespace tw
