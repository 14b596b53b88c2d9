#include "volume/exemplar/paint.h"

#include "volume/base/image.h"

namespace pith::paint {

Rgb measured(int r, int g, int b) {
  return {linear_from_srgb(float(r) / 255.0f), linear_from_srgb(float(g) / 255.0f),
          linear_from_srgb(float(b) / 255.0f)};
}

Rgb color_at(std::span<const Stop> stops, float at) {
  std::size_t i = 1;
  while (i + 1 < stops.size() && stops[i].at < at) ++i;
  const float t = (at - stops[i - 1].at) / (stops[i].at - stops[i - 1].at);
  return mixed(stops[i - 1].color, stops[i].color, std::clamp(t, 0.0f, 1.0f));
}

Channel alpha_channel() {
  return {.name = "alpha", .semantic = Semantic::scalar, .components = 1, .srgb = false, .low = 0, .high = 1};
}
Channel height_channel(float low, float high) {
  return {.name = "height", .semantic = Semantic::height, .components = 1, .srgb = false, .low = low, .high = high};
}
Channel extinction_channel(float high) {
  return {.name = "extinction", .semantic = Semantic::scalar, .components = 1, .srgb = false, .low = 0, .high = high};
}
Channel fiber_channel() {
  return {.name = "fiber", .semantic = Semantic::direction, .components = 3, .srgb = false, .low = -1, .high = 1};
}

namespace {

/// Bytes for linear values in steps of 1/65535: exact to half a step of the byte everywhere.
std::vector<std::uint8_t> srgb_table() {
  std::vector<std::uint8_t> table(65536);
  for (std::size_t i = 0; i < table.size(); ++i)
    table[i] = std::uint8_t(std::lround(255.0f * std::clamp(srgb_from_linear(float(i) / 65535.0f), 0.0f, 1.0f)));
  return table;
}

} // namespace

Exemplar painted(const Canvas& canvas, const ProceduralOptions& options) {
  const int n = options.resolution;
  const int parts = n <= 64 ? 2 : 1; // sub-texels along each axis where texels are coarse
  const int fine = n * parts;

  Exemplar exemplar;
  exemplar.name = canvas.name;
  exemplar.axes = 3;
  exemplar.size = {n, n, n, 1};
  exemplar.wrap = {canvas.wrap[0], canvas.wrap[1], canvas.wrap[2], Wrap::clamp};
  exemplar.channel = canvas.channel;
  const int components = exemplar.component_count();
  exemplar.texel.resize(exemplar.texel_count() * std::size_t(components));

  struct Coding {
    bool srgb;
    float low, high;
  };
  std::vector<Coding> coding;
  for (const Channel& channel : canvas.channel)
    coding.insert(coding.end(), std::size_t(channel.components), {channel.srgb, channel.low, channel.high});
  const std::vector<std::uint8_t> srgb = srgb_table();
  const float share = 1.0f / float(parts * parts * parts);

  parallel_for(std::size_t(n) * n, std::size_t(n), [&](std::size_t line) {
    const int j = int(line % std::size_t(n)), k = int(line / std::size_t(n));
    std::uint8_t* out = exemplar.texel.data() + line * std::size_t(n) * components;
    for (int i = 0; i < n; ++i) {
      Material sum{};
      for (int c = 0; c < parts; ++c)
        for (int b = 0; b < parts; ++b)
          for (int a = 0; a < parts; ++a) {
            const float y = canvas.skin && j == 0 ? 0.5f / float(std::max(fine, 128))
                                                  : (float(j * parts + b) + 0.5f) / float(fine);
            const Material m = canvas.at((float(i * parts + a) + 0.5f) / float(fine), y,
                                         (float(k * parts + c) + 0.5f) / float(fine));
            for (int e = 0; e < components; ++e) sum[e] += m[e];
          }
      for (int e = 0; e < components; ++e) {
        const float value = sum[e] * share;
        if (coding[e].srgb)
          *out++ = srgb[std::size_t(std::clamp(value * 65535.0f + 0.5f, 0.0f, 65535.0f))];
        else
          *out++ = std::uint8_t(
              std::clamp((value - coding[e].low) / (coding[e].high - coding[e].low), 0.0f, 1.0f) * 255.0f + 0.5f);
      }
    }
  });
  return exemplar;
}

} // namespace pith::paint
