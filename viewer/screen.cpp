#include "viewer/screen.h"

#include "volume/io/image_io.h"

namespace pith {

DrawOptions Screen::follow(int width, int height) {
  bench_.aspect = static_cast<double>(width) / height;
  if (material_ != bench_.material_version()) {
    material_ = bench_.material_version();
    drawing_.set_material(bench_.root() ? material_tables(*bench_.root()) : MaterialTables{});
  }
  const DrawnSurface& surface = bench_.surface();
  if (surface_ != bench_.surface_version()) {
    surface_ = bench_.surface_version();
    drawing_.set_surface(surface);
  }
  for (const DrawnPiece& piece : surface.piece) drawing_.set_placement(piece.piece, piece.placement);
  DrawOptions options;
  options.lit = bench_.settings().lit;
  options.occlusion = bench_.settings().occlusion;
  options.filtered = bench_.settings().filtered;
  return options;
}

void Screen::draw(int width, int height) {
  const DrawOptions options = follow(width, height);
  drawing_.draw(bench_.view(), width, height, options);
}

Image Screen::picture(int width, int height, Panels* panels) {
  DrawOptions options = follow(width, height);
  if (panels) {
    panels->build(bench_, width, height); // twice: what has just appeared finds its size in the first
    panels->build(bench_, width, height);
    return drawing_.picture(bench_.view(), width, height, options, [&] { panels->draw(); });
  }
  options.transparent = true;
  return drawing_.picture(bench_.view(), width, height, options);
}

void write_picture(const std::filesystem::path& path, const Image& image) {
  write_image(path, image, {.linear = true});
}

} // namespace pith
