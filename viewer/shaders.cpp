// The twin of volume/layer/composite.cpp and material_at.cpp in GLSL; the tables' layout is in material_tables.h.
// Differences: single precision everywhere, and colour and height only.
#include "viewer/shaders.h"

namespace pith {

const char* const surface_vertex_shader = R"(#version 330 core
layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec3 in_tet;
layout(location = 3) in vec2 in_facet;
layout(location = 4) in ivec3 place; // tet, facet, region
uniform mat4 to_clip;
uniform mat4 to_world; // of the piece
out vec3 world;
out vec3 world_normal;
out vec3 tet_weights;
out vec2 facet_weights;
flat out ivec3 simplex;
void main() {
  vec4 w = to_world * vec4(position, 1.0);
  world = w.xyz;
  world_normal = mat3(to_world) * normal;
  tet_weights = in_tet;
  facet_weights = in_facet;
  simplex = place;
  gl_Position = to_clip * w;
}
)";

const char* const surface_fragment_shader = R"(#version 330 core
in vec3 world;
in vec3 world_normal;
in vec3 tet_weights;
in vec2 facet_weights;
flat in ivec3 simplex;

uniform usamplerBuffer table;
uniform samplerBuffer texels;
uniform samplerBuffer alphas;
uniform int layers;
uniform bool filtered;   // coarser texels where they are smaller than a pixel
uniform bool lit;        // false: the material's colour alone
uniform vec3 eye;        // or, where orthographic, the direction to the eye
uniform bool orthographic;
uniform vec3 key_light;  // unit, towards it
uniform vec3 up;
uniform vec3 uncovered;  // linear, where nothing covers
uniform bool occluded;   // less of the sky is seen from crevices
uniform sampler2D depths; // of the same view
uniform vec2 pixels;     // of the picture
uniform vec2 range;      // of depth, mm
uniform float pixel_mm;  // a pixel's height; where not orthographic, at 1 mm from the eye
uniform mat3 camera;     // rows: right, up, towards the eye
uniform float reach;     // mm: what is farther away occludes nothing
out vec4 pixel;

const uint no_row = 0xffffffffu;
const uint header_rows = 3u;
const float opaque = 0.996;
const int most_weighted = 16;

uvec4 row(uint i) { return texelFetch(table, int(i)); }
vec4 floats(uint i) { return uintBitsToFloat(row(i)); }
uint number(uint first, uint i) { return row(first + (i >> 2))[i & 3u]; }

struct LayerHead {
  int domain, region, width;
  uint mix_rule, select_rule;
  bool mean, color;
  uint begin, lookup, patches, corner, patch_number, corner_rows;
  float grace, correlation;
};

LayerHead head_of(int layer) {
  uint first = header_rows * uint(layer);
  uvec4 a = row(first), b = row(first + 1u), c = row(first + 2u);
  LayerHead h;
  h.domain = int(a.x);
  h.region = int(a.y);
  h.width = int(a.z);
  h.mix_rule = a.w & 255u;
  h.select_rule = (a.w >> 8) & 255u;
  h.mean = ((a.w >> 16) & 1u) != 0u;
  h.color = ((a.w >> 24) & 1u) != 0u;
  h.begin = b.x;
  h.lookup = b.y;
  h.patches = b.z;
  h.corner = b.w;
  h.grace = uintBitsToFloat(c.x);
  h.correlation = uintBitsToFloat(c.y);
  h.patch_number = c.z;
  h.corner_rows = c.w;
  return h;
}

// The corners' weights at the fragment, and how they change from pixel to pixel.
struct Weights {
  vec4 at, dx, dy;
};

struct Sight {
  vec4 w, dx, dy; // coordinates in the patch's unit cube
  float alpha;
  uint patch_row;
};

float mask_alpha(uint mask, vec3 w) {
  uvec4 m = row(mask), n = row(mask + 1u);
  vec3 size = vec3(m.yzw), inside = clamp(w * size - 0.5, vec3(0.0), size - 1.0);
  for (int axis = 0; axis < int(n.y); ++axis)
    if (((n.x >> axis) & 1u) == 0u && !(w[axis] >= 0.0 && w[axis] <= 1.0)) return 0.0;
  ivec3 i = ivec3(inside), step = ivec3(1, int(m.y), int(m.y * m.z)), last = ivec3(m.yzw) - 1;
  vec3 f = inside - vec3(i);
  ivec3 next = min(i + 1, last) - i;
  int at = int(m.x) + i.x + i.y * step.y + i.z * step.z;
  int dx = next.x, dy = next.y * step.y, dz = next.z * step.z;
  float a00 = mix(texelFetch(alphas, at).r, texelFetch(alphas, at + dx).r, f.x);
  float a10 = mix(texelFetch(alphas, at + dy).r, texelFetch(alphas, at + dy + dx).r, f.x);
  float low = mix(a00, a10, f.y);
  if (dz == 0) return low;
  at += dz;
  float a01 = mix(texelFetch(alphas, at).r, texelFetch(alphas, at + dx).r, f.x);
  float a11 = mix(texelFetch(alphas, at + dy).r, texelFetch(alphas, at + dy + dx).r, f.x);
  return mix(low, mix(a01, a11, f.y), f.z);
}

// Weight and mask; alpha 0 where the look-up is not seen.
Sight sight_of(LayerHead h, uint lookup, Weights b) {
  uvec4 c = h.corner_rows * row(h.lookup + lookup) + h.corner;
  vec4 r0 = floats(c.x), r1 = floats(c.y), r2 = floats(c.z);
  vec4 r3 = h.domain == 0 ? floats(c.w) : vec4(0.0);
  Sight s;
  s.w = b.at.x * r0 + b.at.y * r1 + b.at.z * r2 + b.at.w * r3;
  s.dx = s.dy = vec4(0.0);
  if (filtered) {
    s.dx = b.dx.x * r0 + b.dx.y * r1 + b.dx.z * r2 + b.dx.w * r3;
    s.dy = b.dy.x * r0 + b.dy.y * r1 + b.dy.z * r2 + b.dy.w * r3;
  }
  if (h.width == 4) {
    float last = h.domain == 0 ? floats(c.w + 1u).x : 0.0;
    s.alpha = b.at.x * floats(c.x + 1u).x + b.at.y * floats(c.y + 1u).x + b.at.z * floats(c.z + 1u).x + b.at.w * last;
  } else {
    s.alpha = s.w.w;
    s.w.w = s.dx.w = s.dy.w = 0.0;
  }
  s.patch_row = h.patches + 3u * number(h.patch_number, lookup);
  if (s.alpha > 0.0) {
    uint mask = row(s.patch_row + 2u).y;
    if (mask != no_row) s.alpha *= mask_alpha(mask, s.w.xyz);
  }
  return s;
}

// A grid's texels around a place, interpolated along every axis: colour and height.
vec4 grid_value(uint grid, vec4 u) {
  uvec4 m = row(grid + 2u), n = row(grid + 3u);
  int axes = int(n.z);
  ivec4 size = ivec4(ivec3(m.yzw), int(n.x));
  ivec4 low = ivec4(0), high = ivec4(0);
  vec4 f = vec4(0.0);
  int stride = 1;
  for (int axis = 0; axis < axes; ++axis) {
    uint wrap = (n.y >> (2 * axis)) & 3u;
    float p = clamp(u[axis], -1e6, 1e6);
    if (wrap == 1u) {
      p -= floor(p);
    } else if (wrap == 2u) {
      p -= 2.0 * floor(0.5 * p + 0.5);
      p = abs(p);
    } else {
      p = clamp(p, 0.0, 1.0);
    }
    int count = size[axis];
    float at = p * float(count) - 0.5;
    int i = int(floor(at));
    f[axis] = at - float(i);
    int before = wrap == 1u ? count - 1 : 0, behind = wrap == 1u ? 0 : count - 1;
    low[axis] = (i < 0 ? before : min(i, count - 1)) * stride;
    high[axis] = (i + 1 < count ? i + 1 : behind) * stride;
    stride *= count;
  }
  vec4 result = vec4(0.0);
  for (int w = 0; w < (axes == 4 ? 2 : 1); ++w) {
    vec4 cube = vec4(0.0);
    for (int z = 0; z < (axes >= 3 ? 2 : 1); ++z) {
      int base = int(m.x) + (z == 0 ? low.z : high.z) + (w == 0 ? low.w : high.w);
      vec4 first = mix(texelFetch(texels, base + low.y + low.x), texelFetch(texels, base + low.y + high.x), f.x);
      vec4 second = mix(texelFetch(texels, base + high.y + low.x), texelFetch(texels, base + high.y + high.x), f.x);
      vec4 square = mix(first, second, f.y);
      cube = z == 0 ? square : mix(cube, square, f.z);
    }
    result = w == 0 ? cube : mix(result, cube, f.w);
  }
  return floats(grid) + floats(grid + 1u) * result;
}

vec4 exemplar_value(Sight s, bool gaussian) {
  vec4 scale = floats(s.patch_row), offset = floats(s.patch_row + 1u);
  uvec4 source = row(row(s.patch_row + 2u).x);
  uint grid = gaussian ? source.z : source.y;
  vec4 u = scale * s.w + offset;
  if (!filtered || source.x < 2u) return grid_value(grid, u);
  vec4 size = vec4(vec3(row(grid + 2u).yzw), float(row(grid + 3u).x));
  vec4 x = scale * s.dx * size, y = scale * s.dy * size;
  // A pixel's footprint is long and thin where the surface is seen at a slant. Coarser texels are coarser along every
  // axis of a volume, so to follow the long side would mix flesh into the skin: at most eight times the short one.
  float a = dot(x, x), b = dot(y, y);
  float level = clamp(0.5 * log2(max(max(min(a, b), max(a, b) / 64.0), 1.0)), 0.0, float(source.x - 1u));
  uint fine = uint(level);
  vec4 value = grid_value(grid + 4u * fine, u);
  float part = level - float(fine);
  return part > 0.0 ? mix(value, grid_value(grid + 4u * (fine + 1u), u), part) : value;
}

// Blend::mean_over. `value` is multiplied by coverage; squares: sum of the squares of the shares.
vec4 with_variance(LayerHead h, Sight s, float squares, float coverage, vec4 value) {
  float whole = coverage * coverage;
  if (squares >= 0.99 * whole) return value;
  uint grid = row(row(s.patch_row + 2u).x + 1u).x;
  vec4 mean = coverage * grid_value(grid, floats(s.patch_row) * s.w + floats(s.patch_row + 1u));
  float gain = coverage / sqrt(squares + h.correlation * (whole - squares));
  vec4 low = floats(grid), high = low + floats(grid + 1u);
  return clamp(mean + gain * (value - mean), coverage * low, coverage * high);
}

// Colour multiplied by coverage, and coverage.
vec4 composite_over(LayerHead h, uint begin, uint end, Weights b) {
  vec4 value = vec4(0.0);
  float coverage = 0.0, squares = 0.0;
  int read = 0;
  Sight last;
  for (uint i = end; i > begin && coverage < opaque; --i) {
    Sight s = sight_of(h, i - 1u, b);
    if (!(s.alpha > 0.0)) continue;
    float shown = (1.0 - coverage) * min(s.alpha, 1.0);
    value += shown * exemplar_value(s, false);
    coverage += shown;
    squares += shown * shown;
    last = s;
    ++read;
  }
  if (coverage >= opaque) {
    value /= coverage;
    squares /= coverage * coverage;
    coverage = 1.0;
  }
  if (h.mean && read > 1) value = with_variance(h, last, squares, coverage, value);
  return vec4(value.rgb, coverage);
}

vec4 composite_weights(LayerHead h, uint begin, uint end, Weights b) {
  uint kept[most_weighted];
  float weight[most_weighted];
  int count = 0;
  float total = 0.0, sum = 0.0;
  for (uint i = begin; i < end; ++i) {
    float alpha = sight_of(h, i, b).alpha;
    if (!(alpha > 0.0)) continue;
    total += alpha;
    int slot = count;
    if (count == most_weighted) { // the smallest makes room
      slot = 0;
      for (int k = 1; k < most_weighted; ++k)
        if (weight[k] < weight[slot]) slot = k;
      if (weight[slot] >= alpha) continue;
      for (int k = slot; k + 1 < most_weighted; ++k) {
        weight[k] = weight[k + 1];
        kept[k] = kept[k + 1];
      }
      slot = most_weighted - 1;
    } else {
      ++count;
    }
    weight[slot] = alpha;
    kept[slot] = i;
  }
  if (count == 0) return vec4(0.0);
  for (int k = 0; k < count; ++k) sum += weight[k];
  if (sum > 0.0 && sum < total) {
    for (int k = 0; k < count; ++k) weight[k] *= total / sum;
    sum = total;
  }
  float coverage = h.mix_rule == 1u ? min(1.0, sum) : 1.0;
  vec4 values[most_weighted];
  bool histogram = h.mix_rule == 3u;
  if (!histogram || h.select_rule != 0u)
    for (int k = 0; k < count; ++k) values[k] = exemplar_value(sight_of(h, kept[k], b), false);
  if (h.select_rule != 0u) { // Schuster 2020, 3.4.2
    float largest = 0.0, effective[most_weighted];
    for (int k = 0; k < count; ++k) {
      effective[k] = weight[k] * (h.select_rule == 1u ? values[k].a : 1.0 - values[k].a);
      largest = max(largest, effective[k]);
    }
    if (largest > 0.0) {
      float least = max(0.0, largest - h.grace);
      sum = 0.0;
      for (int k = 0; k < count; ++k) {
        weight[k] = max(0.0, effective[k] - least) / h.grace;
        sum += weight[k];
      }
    }
  }
  float squares = 0.0;
  for (int k = 0; k < count; ++k) squares += weight[k] / sum * (weight[k] / sum);
  vec4 mean = vec4(0.0);
  Sight first = sight_of(h, kept[0], b);
  if (histogram) { // Heitz, Neyret 2018
    vec4 gaussian = vec4(0.0);
    for (int k = 0; k < count; ++k)
      gaussian += weight[k] / sum * exemplar_value(sight_of(h, kept[k], b), true);
    gaussian /= sqrt(squares);
    uint inverse = row(row(first.patch_row + 2u).x).w;
    vec4 byte = clamp((gaussian / 6.0 + 0.5) * 255.0, 0.0, 255.0);
    for (int c = 0; c < 3; ++c) {
      uint low = min(254u, uint(byte[c]));
      mean[c] = mix(floats(inverse + low)[c], floats(inverse + low + 1u)[c], byte[c] - float(low));
    }
  } else {
    for (int k = 0; k < count; ++k) mean += weight[k] / sum * values[k];
  }
  vec4 value = coverage * mean;
  if (h.mean && count > 1) value = with_variance(h, first, squares * coverage * coverage, coverage, value);
  return vec4(value.rgb, coverage);
}

// The material's colour (linear), and what covers it.
vec4 material() {
  Weights tet, facet;
  tet.at = vec4(tet_weights, 1.0 - tet_weights.x - tet_weights.y - tet_weights.z);
  facet.at = vec4(facet_weights, 1.0 - facet_weights.x - facet_weights.y, 0.0);
  tet.dx = dFdx(tet.at);
  tet.dy = dFdy(tet.at);
  facet.dx = dFdx(facet.at);
  facet.dy = dFdy(facet.at);
  vec3 color = vec3(0.0);
  float below = 0.0, through = 1.0;
  for (int i = layers - 1; i >= 0; --i) {
    LayerHead h = head_of(i);
    if (h.region >= 0 && h.region != simplex.z) continue;
    if (h.domain == 1 && simplex.y < 0) continue;
    uint at = uint(h.domain == 0 ? simplex.x : simplex.y);
    uint begin = number(h.begin, at), end = number(h.begin, at + 1u);
    if (begin == end) continue;
    Weights b = tet;
    if (h.domain == 1) b = facet;
    vec4 value = h.mix_rule == 0u ? composite_over(h, begin, end, b) : composite_weights(h, begin, end, b);
    if (h.color) {
      color += (1.0 - below) * value.rgb;
      below += (1.0 - below) * value.a;
    }
    through *= 1.0 - value.a;
    if (below >= 0.999) break;
  }
  if (below > 0.0) color /= below;
  return vec4(mix(color, uncovered, through), 1.0 - through);
}

float distance_of(float depth) {
  return orthographic ? mix(range.x, range.y, depth) : range.x * range.y / mix(range.y, range.x, depth);
}

// The share of the sky that is seen, from the depths around (after McGuire, Mara, Luebke 2012, section 2).
float sky_seen(vec3 normal) {
  const int samples = 14;
  vec3 n = camera * normal;
  float here = distance_of(gl_FragCoord.z), mm = orthographic ? pixel_mm : pixel_mm * here;
  float radius = min(reach / mm, 0.25 * pixels.y);
  ivec2 at = ivec2(gl_FragCoord.xy);
  float turn = float((3 * (at.x ^ at.y) + at.x * at.y) & 15) * 0.3927;
  float hidden = 0.0;
  for (int i = 0; i < samples; ++i) {
    float part = (float(i) + 0.5) / float(samples), angle = turn + 7.0 * 6.28319 * part;
    vec2 offset = radius * part * vec2(cos(angle), sin(angle));
    float depth = texture(depths, (gl_FragCoord.xy + offset) / pixels).r;
    vec3 v = vec3(offset * mm, here - distance_of(depth));
    float far = dot(v, v) / (reach * reach);
    hidden += max(1.0 - far, 0.0) * max(dot(v, n) * inversesqrt(dot(v, v) + 1e-12) - 0.12, 0.0);
  }
  return clamp(1.0 - 2.4 * hidden / float(samples), 0.0, 1.0);
}

vec3 encoded(vec3 linear) {
  vec3 c = clamp(linear, 0.0, 1.0);
  return mix(1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, 12.92 * c, lessThanEqual(c, vec3(0.0031308)));
}

void main() {
  vec3 color = material().rgb;
  if (lit) { // a key light, a sky and what the ground sends back; a coat that mirrors the key light
    vec3 n = normalize(world_normal), to_eye = orthographic ? eye : normalize(eye - world);
    if (dot(n, to_eye) < 0.0) n = normalize(n - 1.02 * dot(n, to_eye) * to_eye);
    float sky = 0.5 + 0.5 * dot(n, up);
    float key = max(dot(n, key_light), 0.0), soft = max(0.35 + 0.65 * dot(n, key_light), 0.0);
    vec3 light = mix(vec3(0.44, 0.42, 0.40), vec3(0.66, 0.68, 0.71), sky) + vec3(0.40, 0.39, 0.37) * mix(soft, key, 0.6);
    if (occluded) light *= mix(0.2, 1.0, sky_seen(n));
    float shine = pow(max(dot(n, normalize(key_light + to_eye)), 0.0), 48.0);
    color = color * light + 0.06 * shine;
  }
  pixel = vec4(encoded(color), 1.0);
}
)";

const char* const depth_fragment_shader = R"(#version 330 core
void main() {}
)";

} // namespace pith
