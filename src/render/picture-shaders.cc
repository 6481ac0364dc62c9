// Shaders over the whole picture: light, sky and fog; smoothing of edges.
// SPDX-License-Identifier: LGPL-3.0-or-later
#include "render/shaders.h"

namespace tw::shaders {

// one triangle that covers the picture
const char* const picture_vertex = R"(
uniform vec3 ray_middle;   // to the middle of the picture, at distance 1 along the view
uniform vec3 ray_right;    // from there to the right edge
uniform vec3 ray_up;       // and to the upper edge
out vec3 ray;
void main() {
  vec2 corner = vec2(gl_VertexID == 1 ? 3 : -1, gl_VertexID == 2 ? 3 : -1);
  ray = ray_middle + corner.x * ray_right + corner.y * ray_up;
  gl_Position = vec4(corner, 0, 1);
}
)";

// Radiance = albedo (sun max(n.l, 0) shadow + ambient occlusion (n)) + a faint highlight, then fog
// towards the sky's colour at the horizon, then a tone curve that leaves what is darker than 0.6
// as it is.  The renderer defines SKY (for pixels without a surface: nothing but the sky), SOFTNESS
// (1, 3 or 5 texels across a shadow's edge), SAMPLES (1 or 2 to each side of a pixel), EACH_POINT
// (where to look for what hides the sky) and GRAIN (surfaces that have a grain show it).
const char* const light_fragment = R"(
uniform sampler2D color_map;
uniform sampler2D normal_map;
uniform sampler2D depth_map;
uniform sampler2DShadow sun_map;
uniform sampler2D overhead_map;
uniform mat4 to_sun_map;           // eye-relative world to texture space, depth in z
uniform mat4 to_overhead_map;
uniform float sun_texel;           // side of a texel of the sun's map, m
uniform float sun_map_share;       // one texel as a share of the map
uniform float occlusion_radius;    // m
uniform float overhead_texel;      // m
uniform float overhead_depth;      // from its first depth to its last, radii of occlusion
uniform float near_distance;
uniform vec3 to_sun;
uniform vec3 sun_color;
uniform vec3 zenith;
uniform vec3 horizon;
uniform vec3 ground;
uniform float fog;
#ifdef GRAIN
uniform sampler2D grain_map;
uniform vec3 grain_origin;         // the eye's place, in tiles of the grain
uniform float grain_scale;         // tiles per metre
uniform float grain_level;         // of the map's smaller versions, at 1 m
uniform float grain_strength;      // 0..1
#endif
in vec3 ray;
layout(location = 0) out vec4 out_color;

vec3 decode_normal(vec2 code) {
  vec2 p = 2 * code - 1;
  vec3 n = vec3(p, 1 - abs(p.x) - abs(p.y));
  if (n.z < 0) n.xy = (1 - abs(p.yx)) * vec2(p.x >= 0 ? 1 : -1, p.y >= 0 ? 1 : -1);
  return normalize(n);
}

vec3 sky_color(vec3 d) {
  float glow = max(dot(d, to_sun), 0);
  glow *= glow;
  glow *= glow;
  vec3 low = mix(horizon, sun_color, 0.25 * glow);
  vec3 above = mix(low, zenith, 1 - exp(-4.0 * max(d.z, 0))) + sun_color * (0.10 * glow * glow);
  // a wide soft change below the horizon, as of a backdrop
  return mix(above, ground, smoothstep(-0.05, 0.55, -d.z));
}

// Share of the light that passes: beyond the map's edge all (its outermost texels are infinitely
// deep); behind its last caster as much as just there.
float in_map(sampler2DShadow map, vec3 p) { return texture(map, vec3(p.xy, clamp(p.z, 0, 1))); }

// The comparisons of SOFTNESS x SOFTNESS texels under a tent, each look-up blending four of them.
// Source: I. Castano, "Shadow mapping summary", 2013: where to look up, and with which weights.
float soft_light(vec3 p) {
#if SOFTNESS == 1
  return in_map(sun_map, p);
#else
  vec2 place = p.xy / sun_map_share;
  vec2 base = floor(place + 0.5);
  vec2 s = place + 0.5 - base;
  float sum = 0;
#if SOFTNESS == 3
  const int taps = 2;
  const float total = 16;
  vec2 weight[2] = vec2[](3 - 2 * s, 1 + 2 * s);
  vec2 shift[2] = vec2[]((2 - s) / weight[0] - 1, s / weight[1] + 1);
#else
  const int taps = 3;
  const float total = 144;
  vec2 weight[3] = vec2[](4 - 3 * s, vec2(7), 1 + 3 * s);
  vec2 shift[3] = vec2[]((3 - 2 * s) / weight[0] - 2, (3 + s) / weight[1], s / weight[2] + 2);
#endif
  for (int i = 0; i < taps; ++i)
    for (int j = 0; j < taps; ++j) {
      vec2 tap = base - 0.5 + vec2(shift[i].x, shift[j].y);
      sum += weight[i].x * weight[j].y * in_map(sun_map, vec3(tap * sun_map_share, p.z));
    }
  return sum / total;
#endif
}

float sun_light(vec3 position, vec3 n) {
  // lifted off the surface, so that it does not shade itself
  float slope = 1 - max(dot(n, to_sun), 0);
  vec3 lifted = position + n * (sun_texel * (0.6 + 1.6 * slope)) + to_sun * (0.6 * sun_texel);
  return soft_light((to_sun_map * vec4(lifted, 1)).xyz);
}

// Share of the sky seen: how far above points spread over the half-ball around the normal is what
// lies straight above them?  What is less than 1.5 radii above hides all, what is more than 3 hides
// nothing.  The renderer writes out the points, as EACH_POINT(look) look(x, y, share of the radius)
// ..., for loops are slow here.
float sky_light(vec3 position, vec3 n) {
#ifndef EACH_POINT
  return 1.0;
#else
#if SAMPLES > 1
  // the samples of a pixel look at different points
  float turn = 0.6 * dot(mod(floor(gl_FragCoord.xy), float(SAMPLES)), vec2(1, 2));
  mat2 turned = mat2(cos(turn), sin(turn), -sin(turn), cos(turn));
#else
  const float turned = 1;
#endif
  float hidden = 0, count = 0;
  vec3 base = position + n * max(0.06 * occlusion_radius, 2 * overhead_texel);
  vec3 offset, at;
  float above;   // radii
#define LOOK(x, y, s)                                                                        \
  offset = vec3(turned * vec2(x, y), 0.35) * s;                                              \
  offset += n * (0.30 * s - 2 * min(dot(offset, n) + 0.30 * s, 0));                          \
  at = (to_overhead_map * vec4(base + occlusion_radius * offset, 1)).xyz;                    \
  above = (at.z - texture(overhead_map, at.xy).r) * overhead_depth;                          \
  hidden += clamp(8 * above, 0, 1) * clamp(2 - above / 1.5, 0, 1);                           \
  count += 1;
  EACH_POINT(LOOK)
  return 1 - hidden / count;
#endif
}

// the identity up to a, then up to 1 with the same slope at a
vec3 tone(vec3 c) {
  const float a = 0.6;
  return mix(c, 1 - (1 - a) * exp(-(c - a) / (1 - a)), step(a, c));
}

// Gives ground and rocks that stand fixed a grain: lighter and darker spots, and a rough face.
// Their gloss tells them from others (body-drawer.cc).  The grain is laid on along an axis of the
// world, one that the face looks at.
void add_grain(inout vec4 surface, vec3 position, inout vec3 n) {
#ifdef GRAIN
  float rough = abs(surface.a - 0.1) < 0.03 ? grain_strength : 0.0;
  vec3 place = position * grain_scale + grain_origin;
  vec3 size = abs(n);
  bool on_top = size.z >= 0.5, facing_x = size.x > size.y;
  vec2 at = on_top ? place.xy : facing_x ? place.yz : place.xz;
  float level = log2(length(position)) + grain_level;
  vec3 fine = textureLod(grain_map, at, level).rgb - 0.502;
  vec3 coarse = textureLod(grain_map, 0.25 * at + 0.37, level - 2).rgb - 0.502;
  surface.rgb *= 1 + rough * (0.50 * fine.r + 0.60 * coarse.r);
  vec2 slope = rough * (0.45 * fine.gb + 0.30 * coarse.gb);
  vec3 tilt = on_top ? vec3(slope, 0) : facing_x ? vec3(0, slope) : vec3(slope.x, 0, slope.y);
  n = normalize(n - tilt);
#endif
}

// What a surface sends to the eye.
vec3 surface_light(vec4 surface, vec3 position, vec3 n, vec3 direction) {
  float facing = max(dot(n, to_sun), 0);
  float sun = facing * sun_light(position, n);
  float open = sky_light(position, n);

  // light from the sky above, and thrown back by the ground below
  vec3 ambient =
      mix(0.26 * ground + 0.05 * sun_color, 0.20 * zenith + 0.26 * horizon, 0.5 + 0.5 * n.z);
  vec3 light = sun_color * (1.36 * sun) + ambient * mix(0.25, 1.0, open);
  // cos^48 of the angle to the mirrored sun
  float shine = max(dot(n, normalize(to_sun - direction)), 0);
  shine *= shine * shine;
  shine *= shine;
  shine *= shine;
  shine *= shine;
  shine *= shine;
  float grazing = 1 - max(dot(n, -direction), 0);
  grazing *= grazing;
  float rim = surface.a * grazing * grazing * open;
  return surface.rgb * light + sun_color * (0.45 * surface.a * sun * shine) +
         horizon * (0.20 * rim);
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  float depth = texelFetch(depth_map, pixel, 0).r;
  vec3 direction = normalize(ray);
#ifdef SKY
  vec3 result = sky_color(direction);
#else
  vec3 position = ray * (near_distance / depth);
  vec4 surface = texelFetch(color_map, pixel, 0);
  vec3 n = decode_normal(texelFetch(normal_map, pixel, 0).rg);
  add_grain(surface, position, n);
  vec3 far = sky_color(vec3(direction.xy, max(direction.z, 0.02)));
  vec3 result = mix(surface_light(surface, position, n, direction), far,
                    1 - exp(-fog * length(position)));
#endif
  result = tone(result);
  // the edge filter wants to know how bright a pixel looks
  out_color = vec4(result, sqrt(dot(result, vec3(0.299, 0.587, 0.114))));
}
)";

// Blends along edges found by brightness, in sRGB as it is stored.
// Source: T. Lottes, "FXAA", NVIDIA white paper, 2009 (the variant with four taps along the edge).
const char* const fxaa_fragment = R"(
uniform sampler2D picture;   // linear filter; alpha: brightness
uniform sampler2D pixels;    // the same without filter, which costs less
uniform vec2 pixel_share;    // one pixel as a share of the picture
layout(location = 0) out vec4 out_color;
void main() {
  vec2 p = gl_FragCoord.xy * pixel_share;
  vec4 middle = texture(pixels, p);
  float nw = texture(pixels, p + vec2(-1, 1) * pixel_share).a;
  float ne = texture(pixels, p + vec2(1, 1) * pixel_share).a;
  float sw = texture(pixels, p + vec2(-1, -1) * pixel_share).a;
  float se = texture(pixels, p + vec2(1, -1) * pixel_share).a;
  float low = min(middle.a, min(min(nw, ne), min(sw, se)));
  float high = max(middle.a, max(max(nw, ne), max(sw, se)));
  out_color = vec4(middle.rgb, 1);
  int edges = high - low < max(0.04, 0.11 * high) ? 0 : 1;
  // a loop, since llvmpipe jumps over loops, but computes both sides of an `if` for all pixels
  for (int edge = 0; edge < edges; ++edge) {
    // across the gradient of brightness
    vec2 along = vec2((nw + ne) - (sw + se), (nw + sw) - (ne + se));
    float damp = max((nw + ne + sw + se) * 0.03125, 0.0078);
    along /= min(abs(along.x), abs(along.y)) + damp;
    along = clamp(along, -8.0, 8.0) * pixel_share;
    vec4 narrow = 0.5 * (texture(picture, p - along / 6) + texture(picture, p + along / 6));
    vec4 wide = 0.5 * narrow +
                0.25 * (texture(picture, p - along / 2) + texture(picture, p + along / 2));
    out_color = vec4(wide.a < low || wide.a > high ? narrow.rgb : wide.rgb, 1);
  }
}
)";

// the mean of 2x2 samples, in linear light
const char* const average_fragment = R"(
uniform sampler2D picture;   // linear filter; twice the size
uniform vec2 pixel_share;    // one pixel of the result as a share of the picture
layout(location = 0) out vec4 out_color;
void main() { out_color = vec4(texture(picture, gl_FragCoord.xy * pixel_share).rgb, 1); }
)";

}  // namespace tw::shaders
