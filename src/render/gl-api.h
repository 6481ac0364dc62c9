// The OpenGL functions that drawing uses, as a table filled at run time: no GL library is linked.
//
// Call them as `gl.Clear(...)`.  The loaders hand out a pointer for any name at all, so a feature
// is never tested by its pointer but by version and extension strings.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

#include <GL/glcorearb.h>

#include <functional>

// X(name, NAME): gl##name has the type PFNGL##NAME##PROC
#define TW_GL_FUNCTIONS(X)                            \
  X(ActiveTexture, ACTIVETEXTURE)                     \
  X(AttachShader, ATTACHSHADER)                       \
  X(BindBuffer, BINDBUFFER)                           \
  X(BindFramebuffer, BINDFRAMEBUFFER)                 \
  X(BindSampler, BINDSAMPLER)                         \
  X(BindTexture, BINDTEXTURE)                         \
  X(BindVertexArray, BINDVERTEXARRAY)                 \
  X(BufferData, BUFFERDATA)                           \
  X(CheckFramebufferStatus, CHECKFRAMEBUFFERSTATUS)   \
  X(Clear, CLEAR)                                     \
  X(ClearColor, CLEARCOLOR)                           \
  X(ClearDepth, CLEARDEPTH)                           \
  X(ClipControl, CLIPCONTROL)                         \
  X(CompileShader, COMPILESHADER)                     \
  X(CreateProgram, CREATEPROGRAM)                     \
  X(CreateShader, CREATESHADER)                       \
  X(CullFace, CULLFACE)                               \
  X(DeleteShader, DELETESHADER)                       \
  X(DepthFunc, DEPTHFUNC)                             \
  X(DepthMask, DEPTHMASK)                             \
  X(Disable, DISABLE)                                 \
  X(DrawArrays, DRAWARRAYS)                           \
  X(DrawArraysInstanced, DRAWARRAYSINSTANCED)         \
  X(DrawElementsInstanced, DRAWELEMENTSINSTANCED)     \
  X(DrawBuffers, DRAWBUFFERS)                         \
  X(Enable, ENABLE)                                   \
  X(EnableVertexAttribArray, ENABLEVERTEXATTRIBARRAY) \
  X(Finish, FINISH)                                   \
  X(FramebufferTexture2D, FRAMEBUFFERTEXTURE2D)       \
  X(FrontFace, FRONTFACE)                             \
  X(GenBuffers, GENBUFFERS)                           \
  X(GenFramebuffers, GENFRAMEBUFFERS)                 \
  X(GenSamplers, GENSAMPLERS)                         \
  X(GenTextures, GENTEXTURES)                         \
  X(GenVertexArrays, GENVERTEXARRAYS)                 \
  X(GenerateMipmap, GENERATEMIPMAP)                   \
  X(GetError, GETERROR)                               \
  X(GetIntegerv, GETINTEGERV)                         \
  X(GetProgramInfoLog, GETPROGRAMINFOLOG)             \
  X(GetProgramiv, GETPROGRAMIV)                       \
  X(GetShaderInfoLog, GETSHADERINFOLOG)               \
  X(GetShaderiv, GETSHADERIV)                         \
  X(GetString, GETSTRING)                             \
  X(GetStringi, GETSTRINGI)                           \
  X(GetUniformLocation, GETUNIFORMLOCATION)           \
  X(LinkProgram, LINKPROGRAM)                         \
  X(PixelStorei, PIXELSTOREI)                         \
  X(PolygonOffset, POLYGONOFFSET)                     \
  X(ReadBuffer, READBUFFER)                           \
  X(ReadPixels, READPIXELS)                           \
  X(SamplerParameteri, SAMPLERPARAMETERI)             \
  X(Scissor, SCISSOR)                                 \
  X(ShaderSource, SHADERSOURCE)                       \
  X(TexImage2D, TEXIMAGE2D)                           \
  X(TexParameteri, TEXPARAMETERI)                     \
  X(Uniform1f, UNIFORM1F)                             \
  X(Uniform1i, UNIFORM1I)                             \
  X(Uniform2f, UNIFORM2F)                             \
  X(Uniform3f, UNIFORM3F)                             \
  X(UniformMatrix4fv, UNIFORMMATRIX4FV)               \
  X(UseProgram, USEPROGRAM)                           \
  X(VertexAttribDivisor, VERTEXATTRIBDIVISOR)         \
  X(VertexAttribPointer, VERTEXATTRIBPOINTER)         \
  X(Viewport, VIEWPORT)

namespace tw {

struct GlApi {
#define TW_GL_MEMBER(name, NAME) PFNGL##NAME##PROC name = nullptr;
  TW_GL_FUNCTIONS(TW_GL_MEMBER)
#undef TW_GL_MEMBER
};

using GlLoader = std::function<void*(const char* name)>;

// Fills the table for the context that is current in this thread, and checks that it can do what
// drawing needs: version 3.3 and ARB_clip_control.  Raises UserError that names what is missing.
GlApi load_gl_api(const GlLoader& load);

}  // namespace tw
