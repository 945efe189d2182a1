// Flat arrays for the global stage: in memory while they are small, else mapped from files, so that
// algorithms have plain spans either way.
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <type_traits>
#include <vector>

namespace lacuna {

// All arrays of one computation. Zeroed; they live as long as this.
class Scratch {
 public:
  // Arrays beyond `budget` bytes in total go to files in `folder`.
  Scratch(std::filesystem::path folder, std::uint64_t budget);
  ~Scratch();
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  template <class T>
  std::span<T> array(std::size_t count) {
    static_assert(std::is_trivially_copyable_v<T>);
    return {reinterpret_cast<T*>(allocate(count * sizeof(T))), count};
  }

  // To be called now and then from loops over the arrays (every call is one decrement): gives part of
  // the mapped pages back to the system while they are more than the budget. What they hold stays.
  void trim() {
    if (--trims_left_ == 0) release();
  }

 private:
  struct Mapping {
    std::byte* address;
    std::size_t bytes;
  };
  std::byte* allocate(std::size_t bytes);
  void release();

  std::filesystem::path folder_;
  std::uint64_t budget_;
  std::uint64_t in_memory_ = 0;
  std::uint64_t mapped_before_ = 0;  // of other files: the program and its libraries
  std::uint64_t next_part_ = 0;
  std::uint64_t trims_left_;
  std::vector<std::unique_ptr<std::byte[]>> blocks_;
  std::vector<Mapping> mappings_;
};

}  // namespace lacuna
