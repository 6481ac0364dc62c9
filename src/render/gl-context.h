// An off-screen OpenGL context, its library opened only when something is to be drawn.
//
// OSMesa first, surfaceless EGL where that is missing (Mesa dropped OSMesa in 25.1); both draw with
// llvmpipe on the processor and give the same pixels.  Everything is drawn into framebuffer
// objects: there is no default framebuffer to speak of.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <memory>
#include <string>

#include "render/gl-api.h"

namespace tw {

// Current in the thread that opened it, and used only there; the destructor too runs there.
class GlContext {
 public:
  virtual ~GlContext() = default;
  const GlApi& gl() const { return gl_; }
  // "OSMesa, llvmpipe (LLVM 15.0.6, 256 bits)"
  std::string description() const;

 protected:
  explicit GlContext(std::string backend) : backend_(std::move(backend)) {}
  GlApi gl_;

 private:
  std::string backend_;
};

// A GL library in this process; lives for ever once opened.
class GlLibrary {
 public:
  virtual ~GlLibrary() = default;
  // A new context, current in the calling thread.  Raises UserError.
  virtual std::unique_ptr<GlContext> open_context() const = 0;
};

// Each returns null and says why in `reason` where it cannot be had.
const GlLibrary* open_osmesa_library(std::string& reason);
const GlLibrary* open_egl_library(std::string& reason);

// The library to draw with, opened on the first call; the environment variable TIMEWARP_OPENGL
// chooses `osmesa` or `egl`.  Sets environment variables that Mesa reads, so call it from the main
// thread, before others run.  Raises UserError naming the Debian package to install.
const GlLibrary& gl_library();

}  // namespace tw
