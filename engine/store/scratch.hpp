// SPDX-License-Identifier: Apache-2.0
// Flat arrays for the global stage. They are in memory while they are small, else mapped from files. So
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

// All arrays of one computation. They begin as zeros, and live as long as this object.
class Scratch {
 public:
  // Arrays beyond `budget` bytes in total go to files in `folder`.
  Scratch(std::filesystem::path folder, std::uint64_t budget);
  ~Scratch();
  Scratch(const Scratch&) = delete;
  Scratch& operator=(const Scratch&) = delete;

  // The folder is for other containers of the same algorithm.
  const std::filesystem::path& folder() const { return folder_; }
  std::uint64_t budget() const { return budget_; }

  template <class T>
  std::span<T> array(std::size_t count) {
    static_assert(std::is_trivially_copyable_v<T>);
    return {reinterpret_cast<T*>(allocate(count * sizeof(T))), count};
  }

  // Gives mapped pages back to the system while they are more than the budget. Loops over the arrays call it;
  // most calls are one subtraction. The contents stay. `bytes`: what a loop along an array has passed since
  // the last call. Without such a loop, one access may map a window of pages.
  void trim(std::uint64_t bytes = kWindow) {
    if ((untrimmed_ += bytes) >= between_looks_) release();
  }
  // Calls visit(element) for each element in order.
  template <class T, class Visit>
  void for_each(std::span<T> array, Visit&& visit) {
    for (T& element : array) {
      trim(sizeof(T));
      visit(element);
    }
  }

 private:
  static constexpr std::uint64_t kWindow = 64 << 10;

  struct Mapping {
    std::byte* address;
    std::size_t bytes;
  };
  std::byte* allocate(std::size_t bytes);
  void release();

  std::filesystem::path folder_;
  std::uint64_t budget_;
  std::uint64_t in_memory_ = 0;
  std::uint64_t most_mapped_ = 0;  // by the process, before pages are given back
  std::uint64_t untrimmed_ = 0;    // bytes that may have become resident since the last check
  std::uint64_t between_looks_;
  std::vector<std::unique_ptr<std::byte[]>> blocks_;
  std::vector<Mapping> mappings_;
};

}  // namespace lacuna
