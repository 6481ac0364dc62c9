// Compiling shaders, making framebuffers.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "render/gl-program.h"

#include <array>

#include "base/error.h"

namespace tw {

namespace {

GLuint compile(const GlApi& gl, GLenum kind, const std::string& preamble, const char* source) {
  const GLuint shader = gl.CreateShader(kind);
  const std::string head = "#version 330 core\n" + preamble;
  const std::array<const char*, 2> texts = {head.c_str(), source};
  gl.ShaderSource(shader, 2, texts.data(), nullptr);
  gl.CompileShader(shader);
  GLint compiled = 0;
  gl.GetShaderiv(shader, GL_COMPILE_STATUS, &compiled);
  std::array<char, 2000> log{};
  if (!compiled) gl.GetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
  TW_ASSERT(compiled, log.data());
  return shader;
}

}  // namespace

GlProgram::GlProgram(const GlApi& gl, const char* vertex_source, const char* fragment_source,
                     const std::string& fragment_preamble)
    : gl_(&gl), program_(gl.CreateProgram()) {
  const GLuint vertex = compile(gl, GL_VERTEX_SHADER, "", vertex_source);
  const GLuint fragment = compile(gl, GL_FRAGMENT_SHADER, fragment_preamble, fragment_source);
  gl.AttachShader(program_, vertex);
  gl.AttachShader(program_, fragment);
  gl.LinkProgram(program_);
  gl.DeleteShader(vertex);
  gl.DeleteShader(fragment);
  GLint linked = 0;
  gl.GetProgramiv(program_, GL_LINK_STATUS, &linked);
  std::array<char, 2000> log{};
  if (!linked)
    gl.GetProgramInfoLog(program_, static_cast<GLsizei>(log.size()), nullptr, log.data());
  TW_ASSERT(linked, log.data());
}

void GlProgram::set(const char* name, const Vec3& value) const {
  const Eigen::Vector3f v = value.cast<float>();
  gl_->Uniform3f(find(name), v.x(), v.y(), v.z());
}

GLuint make_texture(const GlApi& gl, GLint format, int width, int height) {
  GLuint texture = 0;
  gl.GenTextures(1, &texture);
  gl.BindTexture(GL_TEXTURE_2D, texture);
  const bool depth = format == GL_DEPTH_COMPONENT32F;
  gl.TexImage2D(GL_TEXTURE_2D, 0, format, width, height, 0, depth ? GL_DEPTH_COMPONENT : GL_RGBA,
                depth ? GL_FLOAT : GL_UNSIGNED_BYTE, nullptr);
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    gl.TexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);
  for (const GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
    gl.TexParameteri(GL_TEXTURE_2D, axis, GL_CLAMP_TO_EDGE);
  return texture;
}

GLuint make_framebuffer(const GlApi& gl, GLuint color0, GLuint color1, GLuint depth) {
  GLuint framebuffer = 0;
  gl.GenFramebuffers(1, &framebuffer);
  gl.BindFramebuffer(GL_FRAMEBUFFER, framebuffer);
  std::array<GLenum, 2> buffers = {GL_NONE, GL_NONE};
  const auto attach = [&](GLenum point, GLuint texture) {
    if (texture) gl.FramebufferTexture2D(GL_FRAMEBUFFER, point, GL_TEXTURE_2D, texture, 0);
  };
  attach(GL_COLOR_ATTACHMENT0, color0);
  attach(GL_COLOR_ATTACHMENT1, color1);
  attach(GL_DEPTH_ATTACHMENT, depth);
  if (color0) buffers[0] = GL_COLOR_ATTACHMENT0;
  if (color1) buffers[1] = GL_COLOR_ATTACHMENT1;
  gl.DrawBuffers(2, buffers.data());
  gl.ReadBuffer(buffers[0]);
  TW_REQUIRE(gl.CheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE &&
                 gl.GetError() == GL_NO_ERROR,
             "cannot draw: not enough memory for a picture of this size and quality");
  return framebuffer;
}

}  // namespace tw
