#include "viewer/drawing.h"

#include "viewer/shaders.h"
#include "volume/base/error.h"

#include <Eigen/LU>
#include <cstring>
#include <epoxy/gl.h>
#include <fmt/format.h>

namespace pith {
namespace {

/// An OpenGL object that goes with its owner.
template <auto Delete>
class Name {
public:
  Name() = default;
  ~Name() { reset(); }
  Name(const Name&) = delete;
  Name& operator=(const Name&) = delete;
  GLuint* address() { return reset(), &name_; }
  operator GLuint() const { return name_; }
  void reset() {
    if (name_) Delete(name_);
    name_ = 0;
  }

private:
  GLuint name_ = 0;
};
using Buffer = Name<[](GLuint n) { glDeleteBuffers(1, &n); }>;
using Texture = Name<[](GLuint n) { glDeleteTextures(1, &n); }>;
using VertexArray = Name<[](GLuint n) { glDeleteVertexArrays(1, &n); }>;
using Framebuffer = Name<[](GLuint n) { glDeleteFramebuffers(1, &n); }>;
using Renderbuffer = Name<[](GLuint n) { glDeleteRenderbuffers(1, &n); }>;

void require_no_error(const char* what) {
  if (const GLenum error = glGetError(); error != GL_NO_ERROR)
    throw SolverFailure(fmt::format("OpenGL could not {} (error {:#06x}{})", what, static_cast<unsigned>(error),
                                    error == GL_OUT_OF_MEMORY ? ", out of memory" : ""));
}

template <class GetLog>
[[noreturn]] void refuse_shader(GetLog get_log, GLuint name) {
  char log[1024] = "";
  get_log(name, sizeof log, nullptr, log);
  throw SolverFailure(fmt::format("this OpenGL driver refuses pith's shader: {}", log));
}

/// A vertex and a fragment shader. In use while values are set.
class Program {
public:
  Program(const char* vertex, const char* fragment) : name_(glCreateProgram()) {
    for (const auto& [kind, source] :
         {std::pair(GL_VERTEX_SHADER, vertex), std::pair(GL_FRAGMENT_SHADER, fragment)}) {
      const GLuint shader = glCreateShader(kind);
      glAttachShader(name_, shader);
      glDeleteShader(shader); // goes with the program
      glShaderSource(shader, 1, &source, nullptr);
      glCompileShader(shader);
      GLint done = 0;
      glGetShaderiv(shader, GL_COMPILE_STATUS, &done);
      if (!done) refuse_shader([](auto... all) { glGetShaderInfoLog(all...); }, shader);
    }
    glLinkProgram(name_);
    GLint done = 0;
    glGetProgramiv(name_, GL_LINK_STATUS, &done);
    if (!done) refuse_shader([](auto... all) { glGetProgramInfoLog(all...); }, name_);
  }
  ~Program() { glDeleteProgram(name_); }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void use() const { glUseProgram(name_); }
  void set(const char* name, int number) const { glUniform1i(at(name), number); }
  void set(const char* name, double number) const { glUniform1f(at(name), float(number)); }
  void set(const char* name, double x, double y) const { glUniform2f(at(name), float(x), float(y)); }
  void set(const char* name, const Vec3d& v) const {
    glUniform3f(at(name), float(v.x()), float(v.y()), float(v.z()));
  }
  void set(const char* name, const Mat3d& m) const {
    const Eigen::Matrix3f f = m.cast<float>();
    glUniformMatrix3fv(at(name), 1, GL_FALSE, f.data());
  }
  void set(const char* name, const Eigen::Matrix4d& m) const {
    const Eigen::Matrix4f f = m.cast<float>();
    glUniformMatrix4fv(at(name), 1, GL_FALSE, f.data());
  }

private:
  GLint at(const char* name) const { return glGetUniformLocation(name_, name); }
  GLuint name_;
};

struct BufferTexture {
  Buffer buffer;
  Texture texture;

  void set(const void* data, std::size_t bytes, GLenum format) {
    glGenBuffers(1, buffer.address());
    glBindBuffer(GL_TEXTURE_BUFFER, buffer);
    glBufferData(GL_TEXTURE_BUFFER, std::max<std::size_t>(bytes, 16), bytes ? data : nullptr, GL_STATIC_DRAW);
    glGenTextures(1, texture.address());
    glBindTexture(GL_TEXTURE_BUFFER, texture);
    glTexBuffer(GL_TEXTURE_BUFFER, format, buffer);
  }
};

/// Rows: right, up, towards the eye.
Mat3d camera_axes(const View& view) {
  Mat3d axes;
  axes.row(0) = view.right().transpose();
  axes.row(1) = view.upward().transpose();
  axes.row(2) = -view.forward().transpose();
  return axes;
}

Eigen::Matrix4d matrix_of(const Rigid& placement) {
  Eigen::Matrix4d m = Eigen::Matrix4d::Identity();
  m.topLeftCorner<3, 3>() = placement.rotation;
  m.topRightCorner<3, 1>() = placement.translation;
  return m;
}

} // namespace

DepthRange depth_range(const View& view, const Box& bounds) {
  const double radius = std::max(0.5 * bounds.diagonal(), 1e-6) * 1.01;
  const double middle = bounds.empty() ? 1 : (bounds.center() - view.eye).dot(view.forward());
  DepthRange range{middle - radius, middle + radius};
  if (!view.orthographic()) {
    range.far = std::max(range.far, 1e-3 * radius);
    range.near = std::max(range.near, 1e-4 * range.far);
  }
  return range;
}

Eigen::Matrix4d clip_matrix(const View& view, double aspect, const DepthRange& range) {
  Eigen::Matrix4d camera = Eigen::Matrix4d::Identity();
  camera.topLeftCorner<3, 3>() = camera_axes(view);
  camera.topRightCorner<3, 1>() = -(camera.topLeftCorner<3, 3>() * view.eye);
  const auto [near, far] = range;
  Eigen::Matrix4d projection = Eigen::Matrix4d::Zero();
  if (view.orthographic()) {
    projection(0, 0) = 2 / (view.height * aspect);
    projection(1, 1) = 2 / view.height;
    projection(2, 2) = -2 / (far - near);
    projection(2, 3) = -(far + near) / (far - near);
    projection(3, 3) = 1;
  } else {
    const double focal = 1 / std::tan(0.5 * view.vertical_angle);
    projection(0, 0) = focal / aspect;
    projection(1, 1) = focal;
    projection(2, 2) = -(far + near) / (far - near);
    projection(2, 3) = -2 * far * near / (far - near);
    projection(3, 2) = -1;
  }
  return projection * camera;
}

struct Drawing::Parts {
  Program program{surface_vertex_shader, surface_fragment_shader};
  Program depth_program{surface_vertex_shader, depth_fragment_shader};
  Texture depth; ///< of the view, for the occlusion
  Framebuffer depth_frame;
  std::array<int, 2> depth_size{0, 0};
  BufferTexture table, texels, alphas;
  std::uint32_t layers = 0;
  VertexArray array;
  Buffer vertices;
  std::vector<DrawnPiece> piece;
  std::vector<Box> bounds; ///< of each piece, at rest

  /// Depths alone, of half as many pixels each way; into `depth`.
  void draw_depth(const Eigen::Matrix4d& to_clip, int width, int height) {
    GLint before = 0;
    glGetIntegerv(GL_FRAMEBUFFER_BINDING, &before);
    const std::array<int, 2> size{std::max(1, width / 2), std::max(1, height / 2)};
    if (size != depth_size) {
      glGenTextures(1, depth.address());
      glBindTexture(GL_TEXTURE_2D, depth);
      glTexImage2D(GL_TEXTURE_2D, 0, GL_DEPTH_COMPONENT32F, size[0], size[1], 0, GL_DEPTH_COMPONENT, GL_FLOAT,
                   nullptr);
      for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
        glTexParameteri(GL_TEXTURE_2D, filter, GL_NEAREST);
      for (const GLenum axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
        glTexParameteri(GL_TEXTURE_2D, axis, GL_CLAMP_TO_EDGE);
      glGenFramebuffers(1, depth_frame.address());
      glBindFramebuffer(GL_FRAMEBUFFER, depth_frame);
      glFramebufferTexture2D(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_TEXTURE_2D, depth, 0);
      glDrawBuffer(GL_NONE);
      glReadBuffer(GL_NONE);
      depth_size = size;
    }
    glBindFramebuffer(GL_FRAMEBUFFER, depth_frame);
    glViewport(0, 0, size[0], size[1]);
    glClear(GL_DEPTH_BUFFER_BIT);
    depth_program.use();
    depth_program.set("to_clip", to_clip);
    draw_pieces(depth_program);
    glBindFramebuffer(GL_FRAMEBUFFER, before);
  }

  void draw_pieces(const Program& in_use) const {
    glBindVertexArray(array);
    for (const DrawnPiece& one : piece) {
      in_use.set("to_world", matrix_of(one.placement));
      glDrawArrays(GL_TRIANGLES, static_cast<GLint>(one.begin), static_cast<GLsizei>(one.end - one.begin));
    }
    glBindVertexArray(0);
  }

  Box world_bounds() const {
    Box all;
    for (std::size_t p = 0; p < piece.size(); ++p) {
      if (bounds[p].empty()) continue;
      for (int i = 0; i < 8; ++i)
        all.add(piece[p].placement(Vec3d((i & 1 ? bounds[p].high : bounds[p].low).x(),
                                         (i & 2 ? bounds[p].high : bounds[p].low).y(),
                                         (i & 4 ? bounds[p].high : bounds[p].low).z())));
    }
    return all;
  }
};

Drawing::Drawing() {
  if (epoxy_gl_version() < 33 || !epoxy_is_desktop_gl())
    throw SolverFailure(fmt::format("pith draws with OpenGL 3.3 or later; this is {}",
                                    reinterpret_cast<const char*>(glGetString(GL_VERSION))));
  parts_ = std::make_unique<Parts>();
  set_material({});
  set_surface({});
}
Drawing::~Drawing() = default;

std::string Drawing::driver() const {
  return fmt::format("{}, OpenGL {}", reinterpret_cast<const char*>(glGetString(GL_RENDERER)),
                     reinterpret_cast<const char*>(glGetString(GL_VERSION)));
}

void Drawing::set_material(const MaterialTables& tables) {
  GLint most = 0;
  glGetIntegerv(GL_MAX_TEXTURE_BUFFER_SIZE, &most);
  const std::size_t needed = std::max({tables.row.size(), tables.texel.size(), tables.alpha.size()});
  if (needed > std::size_t(most))
    throw InvalidInput("model",
                       fmt::format("needs buffer textures of {} texels, and this OpenGL driver has {}", needed, most),
                       "draw it with smaller exemplars or fewer tets, or render it (pith render)");
  parts_->table.set(tables.row.data(), 16 * tables.row.size(), GL_RGBA32UI);
  parts_->texels.set(tables.texel.data(), 8 * tables.texel.size(), GL_RGBA16);
  parts_->alphas.set(tables.alpha.data(), tables.alpha.size(), GL_R8);
  parts_->layers = tables.layers;
  require_no_error("take the material");
}

void Drawing::set_surface(const DrawnSurface& surface) {
  Parts& p = *parts_;
  p.piece = surface.piece;
  p.bounds.assign(p.piece.size(), {});
  for (std::size_t i = 0; i < p.piece.size(); ++i)
    for (std::size_t v = p.piece[i].begin; v < p.piece[i].end; ++v) {
      const auto& x = surface.vertex[v].position;
      p.bounds[i].add(Vec3d(x[0], x[1], x[2]));
    }
  glGenVertexArrays(1, p.array.address());
  glBindVertexArray(p.array);
  glGenBuffers(1, p.vertices.address());
  glBindBuffer(GL_ARRAY_BUFFER, p.vertices);
  glBufferData(GL_ARRAY_BUFFER, surface.vertex.size() * sizeof(DrawnVertex), surface.vertex.data(), GL_STATIC_DRAW);
  const auto attribute = [](GLuint index, int size, std::size_t offset) {
    glEnableVertexAttribArray(index);
    glVertexAttribPointer(index, size, GL_FLOAT, GL_FALSE, sizeof(DrawnVertex), reinterpret_cast<void*>(offset));
  };
  attribute(0, 3, offsetof(DrawnVertex, position));
  attribute(1, 3, offsetof(DrawnVertex, normal));
  attribute(2, 3, offsetof(DrawnVertex, in_tet));
  attribute(3, 2, offsetof(DrawnVertex, in_facet));
  glEnableVertexAttribArray(4);
  glVertexAttribIPointer(4, 3, GL_INT, sizeof(DrawnVertex), reinterpret_cast<void*>(offsetof(DrawnVertex, tet)));
  glBindVertexArray(0);
  require_no_error("take the surface");
}

void Drawing::set_placement(std::uint32_t piece, const Rigid& placement) {
  for (DrawnPiece& drawn : parts_->piece)
    if (drawn.piece == piece) drawn.placement = placement;
}

void Drawing::draw(const View& view, int width, int height, const DrawOptions& options) {
  Parts& p = *parts_;
  glEnable(GL_DEPTH_TEST);
  glDisable(GL_CULL_FACE);
  glDisable(GL_BLEND);
  const Box bounds = p.world_bounds();
  const DepthRange range = depth_range(view, bounds);
  const Eigen::Matrix4d to_clip = clip_matrix(view, double(width) / height, range);
  const bool occluded = options.lit && options.occlusion;
  if (occluded) p.draw_depth(to_clip, width, height);

  glViewport(0, 0, width, height);
  if (options.transparent)
    glClearColor(0, 0, 0, 0);
  else
    glClearColor(0.93f, 0.93f, 0.92f, 1);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  p.program.use();
  int unit = 0;
  const auto bind = [&](const char* name, GLenum kind, GLuint texture) {
    glActiveTexture(GL_TEXTURE0 + unit);
    glBindTexture(kind, texture);
    p.program.set(name, unit++);
  };
  bind("table", GL_TEXTURE_BUFFER, p.table.texture);
  bind("texels", GL_TEXTURE_BUFFER, p.texels.texture);
  bind("alphas", GL_TEXTURE_BUFFER, p.alphas.texture);
  bind("depths", GL_TEXTURE_2D, occluded ? GLuint(p.depth) : 0);
  const double seen = view.orthographic() ? view.height : 2 * std::tan(0.5 * view.vertical_angle);
  p.program.set("occluded", int(occluded));
  p.program.set("pixels", double(width), double(height));
  p.program.set("range", range.near, range.far);
  p.program.set("pixel_mm", seen / height);
  p.program.set("camera", camera_axes(view));
  p.program.set("reach", 0.12 * bounds.diagonal());
  p.program.set("to_clip", to_clip);
  p.program.set("layers", static_cast<int>(p.layers));
  p.program.set("filtered", int(options.filtered));
  p.program.set("lit", int(options.lit));
  p.program.set("orthographic", int(view.orthographic()));
  p.program.set("eye", view.orthographic() ? Vec3d(-view.forward()) : view.eye);
  p.program.set("up", view.upward());
  p.program.set("key_light", Vec3d((0.75 * view.upward() - 0.5 * view.right() - 0.65 * view.forward()).normalized()));
  p.program.set("uncovered", options.uncovered);
  p.draw_pieces(p.program);
  glActiveTexture(GL_TEXTURE0);
  require_no_error("draw");
}

Image Drawing::picture(const View& view, int width, int height, const DrawOptions& options,
                       const std::function<void()>& over) {
  GLint before = 0;
  glGetIntegerv(GL_FRAMEBUFFER_BINDING, &before);
  Framebuffer frame;
  Renderbuffer color, depth;
  glGenFramebuffers(1, frame.address());
  glBindFramebuffer(GL_FRAMEBUFFER, frame);
  glGenRenderbuffers(1, color.address());
  glBindRenderbuffer(GL_RENDERBUFFER, color);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_RGBA8, width, height);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, color);
  glGenRenderbuffers(1, depth.address());
  glBindRenderbuffer(GL_RENDERBUFFER, depth);
  glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, width, height);
  glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth);
  if (glCheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE) {
    glBindFramebuffer(GL_FRAMEBUFFER, before);
    throw SolverFailure(fmt::format("OpenGL cannot draw into a picture of {} × {} pixels", width, height));
  }
  draw(view, width, height, options);
  if (over) over();
  std::vector<std::uint8_t> bytes(std::size_t(width) * height * 4);
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, bytes.data());
  glBindFramebuffer(GL_FRAMEBUFFER, before);
  require_no_error("read the picture back");
  Image image(width, height, 4);
  for (int y = 0; y < height; ++y)
    for (int i = 0; i < 4 * width; ++i)
      image.at(0, y)[i] = bytes[std::size_t(height - 1 - y) * width * 4 + i] / 255.0f;
  return image;
}

} // namespace pith
