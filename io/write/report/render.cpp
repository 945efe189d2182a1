// SPDX-License-Identifier: Apache-2.0
#include "io/write/report/render.hpp"

#include "engine/run/error.hpp"
#include "io/read/files/number.hpp"
#include "io/write/loops/loop_measures.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <new>
#include <string>
#include <utility>

#include <png.h>

namespace lacuna::io {
namespace {

constexpr float kMargin = 1.05f;
constexpr const char* kUndrawn =
    "the loop is not drawn: it runs through points far from all others, or lies above --hide-above";
constexpr float kNearer = 3;  // spacings
constexpr float kLineWidth = 2.5f, kThin = 1.5f,
                kThick = 4.5f;  // pixels; the last two where a loop is chosen
const Eigen::Vector3f kSurface(206, 210, 216), kBoundary(0, 84, 74);

// Maps the scan to the canvas: x and y in parts, z the depth in units of the scan.
class Projection {
 public:
  Projection(const View& view, PictureSize size)
      : view_(view),
        scale_(static_cast<float>(size.height * kFiner) / (2 * view.half_height)),
        corner_(static_cast<float>(size.width * kFiner) / 2, static_cast<float>(size.height * kFiner) / 2) {}

  float scale() const { return scale_; }
  Eigen::Vector3f operator()(const Eigen::Vector3f& p) const {
    const Eigen::Vector3f from = p - view_.middle;
    return {corner_.x() + scale_ * from.dot(view_.right), corner_.y() - scale_ * from.dot(view_.up),
            from.dot(view_.towards)};
  }
  bool is_drawn(const Eigen::Vector3f& p, float depth) const {
    return depth <= view_.before && p.z() <= view_.highest;
  }

 private:
  View view_;
  float scale_;
  Eigen::Vector2f corner_;
};

Eigen::Vector3f colour_of(const Scene::Points& points, std::size_t i, bool as_it_came) {
  if (as_it_came && !points.colours.empty()) {
    const auto [red, green, blue] = points.colours[i];
    return {float(red), float(green), float(blue)};
  }
  const float share = std::clamp((points.probabilities[i] - 0.4f) / 0.5f, 0.0f, 1.0f);
  return kSurface + share * (kBoundary - kSurface);
}

void draw_points(const Scene::Points& points, const View& view, const Projection& project, bool as_it_came,
                 Canvas& canvas) {
  const float radius = std::clamp(0.9f * points.spacing * project.scale(), 0.8f, 12.0f);
  for (std::size_t i = 0; i < points.positions.size(); ++i) {
    const Eigen::Vector3f at = project(points.positions[i]);
    if (!project.is_drawn(points.positions[i], at.z()) || !canvas.reaches(at.y() - radius, at.y() + radius))
      continue;
    const Eigen::Vector3f& normal = points.normals[i];
    const float light = normal.isZero() ? 0.8f : 0.35f + 0.65f * std::abs(normal.dot(view.towards));
    canvas.disc(at.x(), at.y(), radius, at.z(), light * colour_of(points, i, as_it_came));
  }
}

// Calls `draw(x, y, depth)` for each part of a loop, as far as the canvas has it.
template <class Draw>
void trace(const Scene::Loops& loops, std::size_t loop, const Projection& project, const Canvas& canvas,
           const Draw& draw) {
  const std::span<const Eigen::Vector3f> vertices = loops.vertices_of(loop);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Eigen::Vector3f from = vertices[i], to = vertices[(i + 1) % vertices.size()];
    const Eigen::Vector3f a = project(from), b = project(to);
    const float length = std::max((b - a).head<2>().norm(), 1.0f);
    if (length > 4 * float(canvas.height())) continue;  // far beyond the picture
    const float reach = kThick * kFiner;
    if (!canvas.reaches(std::min(a.y(), b.y()) - reach, std::max(a.y(), b.y()) + reach)) continue;
    for (float along = 0; along <= length; along += 1) {
      const Eigen::Vector3f at = a + along / length * (b - a);
      if (project.is_drawn(from + along / length * (to - from), at.z())) draw(at.x(), at.y(), at.z());
    }
  }
}

// Makes what lies behind a hole pale, so that the hole does not look like a closed surface.
void veil_behind(const Scene& scene, std::size_t hole, const View& view, const Projection& project,
                 Canvas& canvas) {
  std::vector<Eigen::Vector3f> outline;
  for (const Eigen::Vector3f& vertex : scene.loops.vertices_of(hole)) outline.push_back(project(vertex));
  const LoopMeasures& measures = scene.loops.measures[hole];
  const Eigen::Vector3f normal = measures.normal.cast<float>();
  const float ahead = normal.dot(view.towards);
  if (!(std::abs(ahead) > 0.1f)) return;
  const Eigen::Vector3f middle = project((measures.centroid - scene.origin).cast<float>());
  const float right = -normal.dot(view.right) / ahead / project.scale();
  const float down = normal.dot(view.up) / ahead / project.scale();
  canvas.veil(
      outline,
      {right, down, middle.z() - right * middle.x() - down * middle.y() - kNearer * scene.points.spacing});
}

// Curves lie on points: they are drawn a little nearer, so that these do not hide them.
void draw_loops(const Scene& scene, const View& view, const Projection& project, Canvas& canvas) {
  const float nearer = kNearer * scene.points.spacing;
  const Scene::Loops& loops = scene.loops;
  const std::vector<bool> are_small = small_loops(loops);
  const auto colour_at = [&](std::size_t loop) {
    const auto [red, green, blue] = io::colour_of(loops.measures[loop].kind);
    return Eigen::Vector3f(red, green, blue);
  };
  if (view.loop && loops.measures[*view.loop].kind == LoopKind::kHole)
    veil_behind(scene, *view.loop, view, project, canvas);
  const float radius = (view.loop ? kThin : kLineWidth) * kFiner / 2;
  for (std::size_t loop = 0; loop < loops.ids.size(); ++loop) {
    if (loop == view.loop || are_small[loop]) continue;
    const Eigen::Vector3f colour = view.loop ? pale(colour_at(loop)) : colour_at(loop);
    trace(loops, loop, project, canvas,
          [&](float x, float y, float depth) { canvas.disc(x, y, radius, depth + nearer, colour); });
  }
  if (!view.loop) return;
  const Eigen::Vector3f colour = colour_at(*view.loop);
  constexpr float kRadius = kThick * kFiner / 2;
  trace(loops, *view.loop, project, canvas,
        [&](float x, float y, float) { canvas.overlay(x, y, kRadius, pale(colour)); });
  trace(loops, *view.loop, project, canvas,
        [&](float x, float y, float depth) { canvas.disc(x, y, kRadius, depth + nearer, colour); });
}

// A small picture of the surface, which says what it hides. It takes 9 MB whatever its shape.
class SeenParts {
 public:
  SeenParts(const Scene& scene, const View& view, float aspect)
      : scene_(scene),
        size_{static_cast<std::size_t>(379.5f * std::sqrt(aspect)),
              static_cast<std::size_t>(379.5f / std::sqrt(aspect))},
        project_(view, size_),
        canvas_(size_, 0, size_.height) {
    draw_points(scene.points, view, project_, false, canvas_);
  }

  // Whether the surface does not hide this vertex of a loop.
  bool shows(const Eigen::Vector3f& vertex) const {
    const Eigen::Vector3f at = project_(vertex);
    return project_.is_drawn(vertex, at.z()) &&
           canvas_.shows(at.x(), at.y(), at.z() + kNearer * scene_.points.spacing);
  }

  // The share of a loop's vertices that it shows.
  float share(std::size_t loop) const {
    const std::span<const Eigen::Vector3f> vertices = scene_.loops.vertices_of(loop);
    const auto seen = std::ranges::count_if(vertices, [&](const auto& vertex) { return shows(vertex); });
    return static_cast<float>(seen) / static_cast<float>(vertices.size());
  }

 private:
  const Scene& scene_;
  PictureSize size_;
  Projection project_;
  Canvas canvas_;
};

std::vector<Label> find_labels(const Scene& scene, const View& view, PictureSize size) {
  const Scene::Loops& loops = scene.loops;
  const std::vector<bool> are_small = small_loops(loops);
  std::vector<std::size_t> order;
  for (std::size_t loop = 0; loop < loops.ids.size(); ++loop)
    if (loop == view.loop || !are_small[loop]) order.push_back(loop);
  const auto rank = [&](std::size_t loop) {
    return std::pair(loop != view.loop, -loops.measures[loop].diameter);
  };
  std::ranges::stable_sort(order, {}, rank);
  const SeenParts seen(scene, view, static_cast<float>(size.width) / static_cast<float>(size.height));
  const Projection project(view, size);
  std::vector<Labelled> labelled;
  for (const std::size_t loop : order) {
    const std::span<const Eigen::Vector3f> vertices = loops.vertices_of(loop);
    std::size_t shown = 0;
    Eigen::AlignedBox2f box;
    for (const Eigen::Vector3f& vertex : vertices) {
      if (loop != view.loop && !seen.shows(vertex)) continue;
      ++shown;
      box.extend(project(vertex).head<2>());
    }
    if (shown > 0 && 2 * shown >= vertices.size()) labelled.push_back({loops.ids[loop], box});
  }
  return place_labels(labelled, size);
}

View looking_from(const Scene& scene, const Eigen::Vector3f& towards, const Eigen::Vector3f& above) {
  View view;
  view.highest = scene.highest;
  view.towards = towards.normalized();
  view.right = above.cross(view.towards).normalized();
  view.up = view.towards.cross(view.right);
  return view;
}

constexpr double kSure = 0.9;      // confidence of holes that a picture holds
constexpr float kLoopPart = 0.6f;  // of the picture's width or height, which a chosen loop fills

std::vector<Eigen::Vector3f> vertices_of_sure(const Scene::Loops& loops) {
  std::vector<Eigen::Vector3f> vertices;
  for (std::size_t i = 0; i < loops.ids.size(); ++i)
    if (loops.measures[i].kind == LoopKind::kHole && loops.measures[i].track.confidence >= kSure)
      vertices.insert(vertices.end(), loops.vertices_of(i).begin(), loops.vertices_of(i).end());
  return vertices;
}

// Chooses half of the height that holds this share of the positions, and all of `others`.
void fit(std::span<const Eigen::Vector3f> positions, double share, std::span<const Eigen::Vector3f> others,
         float aspect, View& view) {
  if (positions.empty()) return;
  const auto range = [&](const Eigen::Vector3f& axis) {
    std::vector<float> along;
    for (const Eigen::Vector3f& p : positions) along.push_back(p.dot(axis));
    auto [low, high] = most_of(along, share);
    for (const Eigen::Vector3f& p : others)
      low = std::min(low, p.dot(axis)), high = std::max(high, p.dot(axis));
    return std::pair{(low + high) / 2, (high - low) / 2};
  };
  const auto [x, half_width] = range(view.right);
  const auto [y, half_height] = range(view.up);
  const auto [z, half_depth] = range(view.towards);
  view.middle = x * view.right + y * view.up + z * view.towards;
  view.half_height = std::max({half_height, half_width / aspect, 1e-6f * half_depth, 1e-30f}) * kMargin;
}

// The view of a loop along its normal, from the side that this points to.
View view_along(const Scene& scene, std::size_t loop, const Eigen::Vector3f& normal, float aspect) {
  View view = looking_from(scene, normal,
                           std::abs(normal.z()) > 0.9f ? Eigen::Vector3f(0, 1, 0) : Eigen::Vector3f(0, 0, 1));
  const std::span<const Eigen::Vector3f> vertices = scene.loops.vertices_of(loop);
  fit(vertices, 1, {}, aspect, view);
  Eigen::AlignedBox3f box;
  float foremost = 0;
  for (const Eigen::Vector3f& vertex : vertices) {
    box.extend(vertex);
    foremost = std::max(foremost, (vertex - view.middle).dot(view.towards));
  }
  const float radius = std::max(box.diagonal().norm() / 2, 3 * scene.points.spacing);
  view.half_height = std::max(view.half_height / (kMargin * kLoopPart), 4 * scene.points.spacing);
  view.before = std::max(0.9f * radius, 1.2f * foremost);
  view.loop = loop;
  return view;
}

struct NamedView {
  std::string_view name;
  Eigen::Vector3f towards, up;
};
const NamedView kNamedViews[] = {{"top", {0, 0, 1}, {0, 1, 0}},
                                 {"front", {0, -1, 0}, {0, 0, 1}},
                                 {"side", {1, 0, 0}, {0, 0, 1}},
                                 {"oblique", {0.6f, -1, 0.8f}, {0, 0, 1}}};

// Returns the index of the loop whose id a view is named by.
std::size_t find_loop(const Scene& scene, std::string_view name) {
  std::uint64_t id = 0;
  const auto& ids = scene.loops.ids;
  const bool is_number = parse_number(name, id);
  const auto found = std::find(ids.begin(), ids.end(), id);
  if (!is_number || found == ids.end()) {
    throw UsageError("view '" + std::string(name) +
                     "': oblique, top, front, side or the id of a loop is allowed" +
                     (ids.empty() ? "; there are no loops" : ", such as " + std::to_string(ids.front())));
  }
  const auto loop = static_cast<std::size_t>(found - ids.begin());
  if (std::ranges::none_of(scene.loops.vertices_of(loop),
                           [&](const auto& v) { return v.z() <= scene.highest; }))
    throw Error("view '" + std::string(name) + "': " + kUndrawn);
  return loop;
}

View view_of_loop(const Scene& scene, std::size_t loop, float aspect) {
  Eigen::Vector3f normal = scene.loops.measures[loop].normal.cast<float>();
  if (!(normal.norm() > 0.5f)) normal = {0, 0, 1};
  // Mostly from above, and a loop in a wall is drawn upright. The other side and views aslant are for what
  // hides it.
  if (normal.z() < -0.01f) normal = -normal;
  const Eigen::Vector3f aslant = 0.7f * normal.unitOrthogonal(), across = normal.cross(aslant);
  View best;
  float most = -1;
  for (const Eigen::Vector3f& side :
       {Eigen::Vector3f(0, 0, 0), aslant, Eigen::Vector3f(-aslant), across, Eigen::Vector3f(-across)}) {
    for (const float sign : {1.0f, -1.0f}) {
      if (most > 0.9f) return best;
      const View view = view_along(scene, loop, (sign * normal + side).normalized(), aspect);
      const float seen = SeenParts(scene, view, aspect).share(loop);
      if (seen <= most + 0.1f) continue;
      most = seen;
      best = view;
    }
  }
  return best;
}

}  // namespace

std::optional<std::size_t> loop_of_view(const Scene& scene, std::string_view name) {
  if (std::ranges::find(kNamedViews, name, &NamedView::name) != std::end(kNamedViews)) return std::nullopt;
  return find_loop(scene, name);
}

View find_view(const Scene& scene, std::string_view name, std::size_t width, std::size_t height) {
  const float aspect = static_cast<float>(width) / static_cast<float>(height);
  if (const auto loop = loop_of_view(scene, name)) return view_of_loop(scene, *loop, aspect);
  const NamedView& named = *std::ranges::find(kNamedViews, name, &NamedView::name);
  View view = looking_from(scene, named.towards, named.up);
  fit(scene.points.positions.empty() ? scene.loops.vertices : scene.points.positions, kFramed,
      vertices_of_sure(scene.loops), aspect, view);
  return view;
}

void render(const Scene& scene, const View& view, PictureSize size, PictureStyle style,
            const std::function<void(std::span<const Colour> row)>& take_row, std::size_t band_bytes) {
  const Projection project(view, size);
  const std::vector<Label> labels = style.has_ids ? find_labels(scene, view, size) : std::vector<Label>();
  const std::size_t band = std::max<std::size_t>(1, band_bytes / (size.width * Canvas::kPixelBytes));
  for (std::size_t row = 0; row < size.height; row += band) {
    Canvas canvas(size, row, std::min(band, size.height - row));
    draw_points(scene.points, view, project, style.as_it_came, canvas);
    draw_loops(scene, view, project, canvas);
    for (const Label& label : labels) draw_label(label, size, canvas);
    canvas.take_rows(take_row);
  }
}

namespace {

// No exception may pass through libpng, which is C. The code keeps the file's exception, and throws it again
// behind libpng.
struct Sink {
  OutputFile& out;
  std::exception_ptr failure;
  std::string message;
};

void write_part(png_structp png, png_bytep data, std::size_t bytes) {
  auto& sink = *static_cast<Sink*>(png_get_io_ptr(png));
  try {
    sink.out.write(std::as_bytes(std::span(data, bytes)));
  } catch (...) {
    sink.failure = std::current_exception();
  }
  if (sink.failure) png_error(png, "the file cannot be written");
}

[[noreturn]] void keep_message(png_structp png, png_const_charp message) {
  static_cast<Sink*>(png_get_error_ptr(png))->message = message;
  png_longjmp(png, 1);
}

}  // namespace

FileMark picture_mark() {
  constexpr std::uint64_t kText = 8 + 25 + 8;  // signature, header, length and type of the text
  return {std::string_view("Software\0Lacuna", 15), kText};
}

struct PngWriter::State {
  explicit State(OutputFile& out) : sink{out, nullptr, {}} {}
  ~State() { png_destroy_write_struct(&png, &info); }

  // Calls libpng, and throws what went wrong.
  template <class Write>
  void write(Write&& write_with) {
    if (setjmp(png_jmpbuf(png)) == 0) write_with(png, info);
    if (sink.failure) std::rethrow_exception(sink.failure);
    if (!sink.message.empty()) throw Error(sink.out.path().string() + ": " + sink.message);
  }

  Sink sink;
  png_structp png = nullptr;
  png_infop info = nullptr;
};

PngWriter::PngWriter(PictureSize size, OutputFile& out) : state_(std::make_unique<State>(out)) {
  State& state = *state_;
  state.png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &state.sink, keep_message, nullptr);
  state.info = state.png ? png_create_info_struct(state.png) : nullptr;
  if (!state.info) throw std::bad_alloc();
  static char software[] = "Software", name[] = "Lacuna " LACUNA_VERSION;
  state.write([&](png_structp png, png_infop info) {
    png_text text{};
    text.compression = PNG_TEXT_COMPRESSION_NONE;
    text.key = software;
    text.text = name;
    png_set_write_fn(png, &state.sink, write_part, nullptr);
    png_set_IHDR(png, info, static_cast<png_uint_32>(size.width), static_cast<png_uint_32>(size.height), 8,
                 PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
                 PNG_FILTER_TYPE_DEFAULT);
    png_set_text(png, info, &text, 1);
    png_write_info(png, info);
  });
}

PngWriter::~PngWriter() = default;

void PngWriter::write(std::span<const Colour> row) {
  state_->write([row](png_structp png, png_infop) {
    png_write_row(png, reinterpret_cast<png_const_bytep>(row.data()));
  });
}

void PngWriter::finish() {
  state_->write([](png_structp png, png_infop) { png_write_end(png, nullptr); });
}

}  // namespace lacuna::io
