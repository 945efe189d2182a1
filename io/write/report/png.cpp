// SPDX-License-Identifier: Apache-2.0
#include "engine/run/error.hpp"
#include "io/write/report/render.hpp"

#include <exception>
#include <new>
#include <span>
#include <string>
#include <string_view>

#include <png.h>

namespace lacuna::io {
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
