// Shaders of surfaces and shadow maps.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "render/shaders.h"

namespace tw::shaders {

const char* const mesh_vertex = R"(
uniform mat4 projection;              // eye-relative world to clip space
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 row_x;   // body to eye-relative world
layout(location = 3) in vec4 row_y;
layout(location = 4) in vec4 row_z;
layout(location = 5) in vec4 color;   // linear; gloss
layout(location = 6) in vec3 tint;    // linear
layout(location = 7) in vec2 place;   // in the texture
out vec3 surface_normal;
out vec3 surface_tint;
out vec2 surface_place;
flat out vec4 surface_color;
void main() {
  vec4 p = vec4(position, 1);
  gl_Position = projection * vec4(dot(row_x, p), dot(row_y, p), dot(row_z, p), 1);
  // by the cofactors of the matrix, which may stretch
  surface_normal = vec3(dot(cross(row_y.xyz, row_z.xyz), normal),
                        dot(cross(row_z.xyz, row_x.xyz), normal),
                        dot(cross(row_x.xyz, row_y.xyz), normal));
  surface_tint = tint;
  surface_place = place;
  surface_color = color;
}
)";

// A unit normal as a point of the octahedron |x| + |y| + |z| = 1, unfolded into the unit square.
// Source: Cigolle et al., Survey of efficient representations for unit vectors, JCGT 3(2), 2014.
const char* const surface_preamble = R"(
vec2 encode_normal(vec3 n) {
  vec2 p = n.xy / (abs(n.x) + abs(n.y) + abs(n.z));
  if (n.z < 0) p = (1 - abs(p.yx)) * vec2(p.x >= 0 ? 1 : -1, p.y >= 0 ? 1 : -1);
  return 0.5 * p + 0.5;
}
layout(location = 0) out vec4 out_color;
layout(location = 1) out vec2 out_normal;
)";

// Backs are seen of what is open only: what is closed is culled there.
const char* const mesh_fragment = R"(
in vec3 surface_normal;
in vec3 surface_tint;
flat in vec4 surface_color;
#ifdef TEXTURED
uniform sampler2D surface_map;
in vec2 surface_place;
#endif
void main() {
  vec3 color = surface_tint * surface_color.rgb;
#ifdef TEXTURED
  vec4 texel = texture(surface_map, surface_place);
  if (texel.a < 0.5) discard;
  color *= texel.rgb;
#endif
  out_color = vec4(color, surface_color.a);
  vec3 normal = normalize(surface_normal);
  out_normal = encode_normal(gl_FrontFacing ? normal : -normal);
}
)";

// The quad that just covers the cone of sight around the sphere: in the plane of the circle where
// the cone touches it, at 1 - r^2/d^2 of the way to the centre, of radius r sqrt(1 - r^2/d^2).
const char* const sphere_vertex = R"(
uniform mat4 projection;
layout(location = 0) in vec2 corner;  // -1 or 1
layout(location = 1) in vec4 ball;    // centre relative to the eye; radius
layout(location = 2) in vec4 color;
out vec3 ray;
flat out vec4 surface_ball;
flat out vec4 surface_color;
void main() {
  float d2 = dot(ball.xyz, ball.xyz);
  float share = 1 - ball.w * ball.w / d2;
  vec3 axis = ball.xyz * inversesqrt(d2);
  vec3 across = normalize(abs(axis.z) < 0.9 ? vec3(axis.y, -axis.x, 0) : vec3(0, axis.z, -axis.y));
  vec3 up = cross(across, axis);
  // inside the ball there is nothing to see
  float size = share > 0 ? ball.w * sqrt(share) * 1.0001 : 0;
  ray = share * ball.xyz + size * (corner.x * across + corner.y * up);
  gl_Position = projection * vec4(ray, 1);
  surface_ball = ball;
  surface_color = color;
}
)";

// Where the ray meets the sphere: the centre's foot on the ray, minus half the chord.
const char* const sphere_fragment = R"(
uniform vec3 forward;
uniform float near_distance;
in vec3 ray;
flat in vec4 surface_ball;
flat in vec4 surface_color;
void main() {
  vec3 direction = normalize(ray);
  float foot = dot(direction, surface_ball.xyz);
  vec3 across = foot * direction - surface_ball.xyz;
  float half_chord2 = surface_ball.w * surface_ball.w - dot(across, across);
  if (half_chord2 < 0) discard;
  vec3 hit = (foot - sqrt(half_chord2)) * direction;
  out_color = surface_color;
  out_normal = encode_normal((hit - surface_ball.xyz) / surface_ball.w);
  gl_FragDepth = near_distance / max(dot(hit, forward), near_distance);
}
)";

const char* const ground_vertex = R"(
uniform mat4 projection;
layout(location = 0) in vec3 position;     // relative to the eye
void main() { gl_Position = projection * vec4(position, 1); }
)";

// Checks and lines averaged over the pixel's box, so that they fade into grey far away.  The point
// is found from the pixel's ray, since interpolation over a polygon of kilometres is too coarse.
// Source: I. Quilez, "box-filtered checkerboard".
const char* const ground_fragment = R"(
uniform vec3 normal;
uniform vec3 color;         // linear
uniform float height;       // normal.x of the plane's points x, relative to the eye
uniform vec3 cell_u;        // coordinates on the plane, in cells ...
uniform vec3 cell_v;
uniform vec2 cell_origin;   // ... counted from an even cell near the eye
uniform vec3 ray_middle;
uniform vec3 ray_right;
uniform vec3 ray_up;
uniform vec2 pixel_share;   // one pixel as a share of the picture
float checks(vec2 p, vec2 width) {
  vec2 wave = 2 * (abs(fract((p - 0.5 * width) * 0.5) - 0.5) -
                   abs(fract((p + 0.5 * width) * 0.5) - 0.5)) / width;
  return 0.5 - 0.5 * wave.x * wave.y;
}
// how much of a line that is `share` wide in every cell lies below p
vec2 line_sum(vec2 p, float share) { return floor(p) * share + min(fract(p), share); }
float lines(vec2 p, vec2 width) {
  const float share = 0.025;
  p += 0.5 * share;
  vec2 covered = (line_sum(p + 0.5 * width, share) - line_sum(p - 0.5 * width, share)) / width;
  return 1 - (1 - covered.x) * (1 - covered.y);
}
void main() {
  vec2 place = 2 * gl_FragCoord.xy * pixel_share - 1;
  vec3 ray = ray_middle + place.x * ray_right + place.y * ray_up;
  vec3 point = ray * (height / dot(normal, ray));
  vec2 cell = vec2(dot(cell_u, point), dot(cell_v, point)) + cell_origin;
  vec2 width = max(abs(dFdx(cell)) + abs(dFdy(cell)), 1e-4);
  float tone = 0.94 + 0.12 * checks(cell, width) - 0.16 * lines(cell, width);
  out_color = vec4(color * tone, 0);
  out_normal = encode_normal(normal);
}
)";

const char* const mesh_shadow_vertex = R"(
uniform mat4 projection;
layout(location = 0) in vec3 position;
layout(location = 2) in vec4 row_x;
layout(location = 3) in vec4 row_y;
layout(location = 4) in vec4 row_z;
void main() {
  vec4 p = vec4(position, 1);
  gl_Position = projection * vec4(dot(row_x, p), dot(row_y, p), dot(row_z, p), 1);
}
)";

const char* const mesh_shadow_fragment = R"(
void main() {}
)";

// A sphere throws the shadow of the disc through its centre across the light; the disc lies behind
// all that the light reaches, so that the sphere never shades itself.
const char* const sphere_shadow_vertex = R"(
uniform mat4 projection;
uniform vec3 light_right;
uniform vec3 light_up;
layout(location = 0) in vec2 corner;
layout(location = 1) in vec4 ball;
out vec2 place;
void main() {
  place = corner;
  vec3 p = ball.xyz + ball.w * (corner.x * light_right + corner.y * light_up);
  gl_Position = projection * vec4(p, 1);
}
)";

const char* const sphere_shadow_fragment = R"(
in vec2 place;
void main() {
  if (dot(place, place) > 1) discard;
}
)";

}  // namespace tw::shaders
