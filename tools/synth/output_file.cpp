#include "tools/synth/output_file.hpp"

#include "engine/core/error.hpp"

#include <cerrno>
#include <system_error>

namespace lacuna::synth {

namespace {

constexpr std::size_t kBufferBytes = std::size_t{4} << 20;

}  // namespace

OutputFile::OutputFile(std::filesystem::path name)
    : name_(std::move(name)), partial_(name_.string() + ".partial"), buffer_(kBufferBytes) {
  file_.reset(std::fopen(partial_.c_str(), "wb"));
  if (!file_) fail();
  std::setvbuf(file_.get(), nullptr, _IONBF, 0);
}

OutputFile::~OutputFile() {
  if (committed_) return;
  file_.reset();
  std::error_code ignored;
  std::filesystem::remove(partial_, ignored);
}

void OutputFile::fail() const {
  throw Error(partial_.string() + ": cannot write: " + std::generic_category().message(errno));
}

void OutputFile::flush() {
  if (std::fwrite(buffer_.data(), 1, used_, file_.get()) != used_) fail();
  used_ = 0;
}

void OutputFile::make_room(std::size_t size) {
  flush();
  if (size > buffer_.size()) buffer_.resize(size);
}

void OutputFile::overwrite_start(std::string_view text) {
  flush();
  if (std::fseek(file_.get(), 0, SEEK_SET) != 0) fail();
  if (std::fwrite(text.data(), 1, text.size(), file_.get()) != text.size()) fail();
  if (std::fseek(file_.get(), 0, SEEK_END) != 0) fail();
}

void OutputFile::finish() {
  if (!file_) return;
  flush();
  if (std::fclose(file_.release()) != 0) fail();
}

void OutputFile::commit() {
  finish();
  std::error_code error;
  std::filesystem::rename(partial_, name_, error);
  if (error) throw Error(name_.string() + ": cannot rename the finished file: " + error.message());
  committed_ = true;
}

}  // namespace lacuna::synth
