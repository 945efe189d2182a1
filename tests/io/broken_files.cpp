// SPDX-License-Identifier: Apache-2.0
#include "tests/io/broken_files.hpp"

#include <sys/resource.h>

namespace lacuna::test {
namespace {

constexpr std::string_view kOfNumbers = "0123456789+-.eE";

class Mutation {
 public:
  Mutation(std::string whole, std::uint32_t seed, std::uint32_t number) : bytes_(std::move(whole)) {
    std::seed_seq both = {seed, number};
    random_.seed(both);
  }

  std::string apply() {
    using Change = void (Mutation::*)();
    constexpr std::array<Change, 7> kChanges = {
        &Mutation::set_byte,    &Mutation::remove_span,    &Mutation::repeat_span,   &Mutation::insert_span,
        &Mutation::set_integer, &Mutation::add_to_integer, &Mutation::replace_number};
    constexpr std::array<std::size_t, 8> kCounts = {1, 1, 1, 1, 2, 2, 3, 4};
    const std::size_t changes = one_of(kCounts);
    for (std::size_t i = 0; i < changes && !bytes_.empty(); ++i) (this->*one_of(kChanges))();
    if (below(50) == 0) bytes_.resize(below(bytes_.size() + 1));
    return std::move(bytes_);
  }

 private:
  std::size_t below(std::size_t end) { return end == 0 ? 0 : random_() % end; }

  template <class Values>
  typename Values::const_reference one_of(const Values& values) {
    return values[below(values.size())];
  }

  // Bytes near each other: short ones are more frequent.
  struct Span {
    std::size_t begin, length;
  };
  Span span() {
    const std::size_t begin = below(bytes_.size());
    const std::size_t longest = std::min(bytes_.size() - begin, std::size_t{1} << below(9));
    return {begin, 1 + below(longest)};
  }

  char byte() {
    constexpr std::string_view kBoundaries("\x00\xff\x7f\x80\x01\n\r \t#", 10);
    return below(2) ? one_of(kBoundaries) : static_cast<char>(random_());
  }

  void set_byte() { bytes_[below(bytes_.size())] = byte(); }

  void remove_span() {
    const Span some = span();
    bytes_.erase(some.begin, some.length);
  }

  void repeat_span() {
    const Span some = span();
    const std::string copy = bytes_.substr(some.begin, some.length);
    for (std::size_t times = 1 + below(3); times > 0; --times) bytes_.insert(some.begin, copy);
  }

  void insert_span() {
    std::string some(1 + below(std::size_t{1} << below(8)), byte());
    if (below(2)) std::generate(some.begin(), some.end(), [&] { return byte(); });
    bytes_.insert(below(bytes_.size() + 1), some);
  }

  // An integer of 1 to 8 bytes, mostly at a multiple of its size.
  Span integer() {
    const std::size_t size = std::min(std::size_t{1} << below(4), bytes_.size());
    const std::size_t place = below(bytes_.size() - size + 1);
    return {below(4) ? place / size * size : place, size};
  }

  std::uint64_t load(const Span& at) const {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < at.length; ++i)
      value |= std::uint64_t{static_cast<unsigned char>(bytes_[at.begin + i])} << 8 * i;
    return value;
  }

  void store(const Span& at, std::uint64_t value, bool swapped = false) {
    for (std::size_t i = 0; i < at.length; ++i)
      bytes_[at.begin + (swapped ? at.length - 1 - i : i)] = static_cast<char>(value >> 8 * i);
  }

  void set_integer() {
    const Span at = integer();
    const std::uint64_t sign = std::uint64_t{1} << (8 * at.length - 1);
    const std::array<std::uint64_t, 9> values = {
        0, 1, ~std::uint64_t{0}, ~std::uint64_t{1}, sign, sign - 1, sign >> 1, 1 + below(1000), random_()};
    store(at, one_of(values), below(4) == 0);
  }

  void add_to_integer() {
    const Span at = integer();
    store(at, load(at) + below(9) - 4);
  }

  // Places of characters that numbers have.
  std::vector<std::size_t> digits() const {
    std::vector<std::size_t> places;
    for (std::size_t i = 0; i < bytes_.size(); ++i)
      if (bytes_[i] >= '0' && bytes_[i] <= '9') places.push_back(i);
    return places;
  }

  void replace_number() {
    constexpr const char* kNumbers =
        "0 1 -1 2 65535 65536 2147483647 4294967295 4294967296 1e999 -nan nan inf 1e-999 0.5 00000000 "
        "1000000 "
        "18446744073709551615 9223372036854775808 - . , /";
    std::istringstream numbers(kNumbers);
    const std::vector<std::string> instead{std::istream_iterator<std::string>(numbers), {}};
    const std::vector<std::size_t> places = digits();
    if (places.empty()) return;
    std::size_t begin = one_of(places), end = begin;
    while (begin > 0 && kOfNumbers.find(bytes_[begin - 1]) != kOfNumbers.npos) --begin;
    while (end < bytes_.size() && kOfNumbers.find(bytes_[end]) != kOfNumbers.npos) ++end;
    bytes_.replace(begin, end - begin, one_of(instead));
  }

  std::string bytes_;
  std::mt19937_64 random_;
};

}  // namespace

std::string mutated(const std::string& whole, std::uint32_t seed, std::uint32_t number) {
  return Mutation(whole, seed, number).apply();
}

namespace {

void require(bool holds, const char* what) {
  if (!holds) throw std::logic_error(what);
}

void check_layout(const RowLayout& layout) {
  std::set<std::string> names;
  std::size_t bytes = 0;
  for (const Property& property : layout.properties) {
    require(!property.name.empty() && names.insert(property.name).second, "names of properties differ");
    require(property.offset == bytes, "properties are packed");
    bytes += size_of(property.type);
  }
  require(layout.stride == bytes, "rows are packed");
  require(layout.find("x") && layout.find("y") && layout.find("z"), "rows have x, y and z");
}

// One line that names the file and gives a reason, without control characters.
void check_message(const std::string& message, const fs::path& file) {
  constexpr std::size_t kLongestReason = 1000;
  INFO("the message: " << message);
  const std::string begin = file.string() + ": ";
  CHECK(message.starts_with(begin));
  CHECK(message.size() > begin.size() + 10);
  CHECK(message.size() < begin.size() + kLongestReason);
  CHECK(std::none_of(message.begin(), message.end(),
                     [](char c) { return static_cast<unsigned char>(c) < ' ' || c == 0x7f; }));
}

std::uint64_t most_megabytes_so_far() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<std::uint64_t>(usage.ru_maxrss) / 1024;
}

// The sanitizers slow down and take memory of their own.
#ifdef __SANITIZE_ADDRESS__
constexpr bool kIsSanitized = true;
#else
constexpr bool kIsSanitized = false;
#endif
constexpr std::clock_t kLongest = (kIsSanitized ? 60 : 5) * CLOCKS_PER_SEC;  // of the processor

// Writes `bytes` and reads them. None where that was an error.
std::optional<std::vector<Point>> read_broken(const WholeFile& whole, const ScratchFolder& folder,
                                              const std::string& bytes, std::size_t max_rows,
                                              bool keeps_points) {
  const fs::path file = folder.write(whole.name, bytes);
  const std::clock_t begin = std::clock();
  const std::uint64_t before = most_megabytes_so_far();
  std::optional<std::vector<Point>> points(std::in_place);
  std::string wrong;
  try {
    whole.read(file, max_rows, bytes.size() * whole.points_in_a_byte, [&](const Point& point) {
      if (keeps_points) points->push_back(point);
    });
  } catch (const Error& error) {
    check_message(error.what(), file);
    points.reset();
  } catch (const std::exception& other) {
    wrong = other.what();
  }
  fs::remove(file);  // a new file is written faster than an old one anew, which ext4 flushes
  CHECK(wrong == "");
  CHECK(std::clock() - begin < kLongest);
  if (!kIsSanitized) CHECK(most_megabytes_so_far() - before <= whole.megabytes);
  return points;
}

bool is_same(const Point& a, const Point& b) {
  return std::memcmp(a.data(), b.data(), sizeof a) == 0;  // NaN equals itself
}

// The last point of text may have lost digits.
bool is_beginning(const std::vector<Point>& some, const std::vector<Point>& all) {
  return some.size() <= all.size() &&
         (some.empty() || std::equal(some.begin(), some.end() - 1, all.begin(), is_same));
}

void check_cuts(const WholeFile& whole, const ScratchFolder& folder) {
  const auto all = read_broken(whole, folder, whole.bytes, 1000, true);
  REQUIRE(all);
  for (std::size_t length = 0; length < whole.bytes.size(); ++length) {
    INFO(whole.name << " cut to " << length << " of " << whole.bytes.size() << " bytes");
    const auto some = read_broken(whole, folder, whole.bytes.substr(0, length), 1 + length % 3, true);
    if (length >= whole.complete_from && whole.complete_from > 0) {
      REQUIRE(some);
      CHECK(std::equal(some->begin(), some->end(), all->begin(), all->end(), is_same));
    } else if (some) {
      CHECK(whole.complete_from == 0);
      CHECK(is_beginning(*some, *all));
    }
  }
}

void check_changes(const WholeFile& whole, const ScratchFolder& folder, std::uint32_t seed,
                   std::uint64_t count) {
  constexpr std::array<std::size_t, 4> kMaxRows = {1, 2, 7, 1000};
  for (std::uint32_t number = 0; number < count; ++number) {
    INFO(whole.name << " of " << whole.bytes.size() << " bytes, changed: seed " << seed << ", number "
                    << number);
    read_broken(whole, folder, mutated(whole.bytes, seed, number), kMaxRows[number % kMaxRows.size()], false);
  }
}

}  // namespace

void read_scan(const fs::path& file, std::size_t max_rows, std::uint64_t most_points,
               const PointVisitor& visit) {
  const auto reader = open_scan(file, {});
  const RowLayout& layout = reader->layout();
  check_layout(layout);
  const std::array<const Property*, 3> axes = {layout.find("x"), layout.find("y"), layout.find("z")};
  const auto expected = reader->expected_rows();
  require(!expected || *expected <= most_points, "no more rows are expected than the file can hold");
  std::uint64_t rows = 0;
  RowBatch batch;
  while (reader->next(batch, max_rows)) {
    require(batch.count > 0 && batch.count <= max_rows, "batches have rows, but not too many");
    require(batch.bytes.size() == batch.count * layout.stride, "batches have the bytes of their rows");
    rows += batch.count;
    require(rows <= most_points, "there are no more rows than the file can hold");
    for (std::size_t row = 0; row < batch.count; ++row) {
      const std::byte* const bytes = batch.bytes.data() + row * layout.stride;
      visit({value_of(bytes, *axes[0]), value_of(bytes, *axes[1]), value_of(bytes, *axes[2])});
    }
  }
  require(!expected || *expected == rows, "there are as many rows as expected");
}

void check_broken_files(const std::vector<WholeFile>& files, std::uint32_t seed) {
  constexpr std::uint64_t kChanges = 300;
  const ScratchFolder folder;
  for (const WholeFile& whole : files) {
    check_cuts(whole, folder);
    check_changes(whole, folder, seed, kChanges / files.size());
  }
}

void check_many_broken_files(const std::vector<WholeFile>& files, std::uint32_t seed) {
  constexpr std::uint64_t kChanges = 10'000;
  const ScratchFolder folder;
  for (const WholeFile& whole : files) {
    check_cuts(whole, folder);
    check_changes(whole, folder, seed, draws(kChanges));
  }
}

}  // namespace lacuna::test
