// The programs that run per vertex and per pixel, in GLSL 3.30.
//
// Passes: shadow maps; surfaces (colour and normal of what is nearest); light (shadow, grain, fog,
// tone), or sky; edges (FXAA or 2x2 averaging).  Positions are relative to the eye, in axes of the
// world.
//
// SPDX-License-Identifier: LGPL-3.0-or-later
#pragma once

namespace tw::shaders {

// what the fragment shaders of surfaces begin with: their outputs
extern const char* const surface_preamble;
// facets and smooth meshes: instances are 3x4 matrices and colours
extern const char* const mesh_vertex;
extern const char* const mesh_fragment;
// spheres, met exactly by the ray of each pixel: instances are centres, radii and colours
extern const char* const sphere_vertex;
extern const char* const sphere_fragment;
// faces of half-spaces with their checks and lines
extern const char* const ground_vertex;
extern const char* const ground_fragment;
// depth as seen from the light
extern const char* const mesh_shadow_vertex;
extern const char* const mesh_shadow_fragment;
extern const char* const sphere_shadow_vertex;
extern const char* const sphere_shadow_fragment;
// over the whole picture
extern const char* const picture_vertex;
extern const char* const light_fragment;
extern const char* const fxaa_fragment;
extern const char* const average_fragment;

}  // namespace tw::shaders
