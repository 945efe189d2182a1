// SPDX-License-Identifier: Apache-2.0
// Contexts by which the decoders of POINT10 and POINT14 choose their models.
#pragma once

#include "io/read/laz/symbol_model.hpp"

#include <algorithm>
#include <array>
#include <memory>

namespace lacuna::io::laz {

// Returns how many returns of its pulse a point is from the last one; |n - r| also for return numbers that
// are not possible.
inline unsigned return_level(unsigned number_of_returns, unsigned return_number) {
  return number_of_returns > return_number ? number_of_returns - return_number
                                           : return_number - number_of_returns;
}

// The context of the y difference by the k of the x difference, and of z by the mean k of both. It is an even
// number up to `largest`, and the next odd one for the only return of a pulse.
inline unsigned k_context(unsigned k, unsigned largest, bool only_return) {
  return std::min(k & ~1u, largest) + (only_return ? 1 : 0);
}
inline constexpr unsigned kLargestYContext = 20;
inline constexpr unsigned kLargestZContext = 18;

// A model for each value that came before; most values never come, so a model is made when it is first
// needed.
template <unsigned kSymbols, unsigned kContexts>
class ModelByValue {
 public:
  SymbolModel<kSymbols>& operator[](unsigned context) {
    auto& model = models_[context];
    if (!model) model = std::make_unique<SymbolModel<kSymbols>>();
    return *model;
  }

 private:
  std::array<std::unique_ptr<SymbolModel<kSymbols>>, kContexts> models_;
};

}  // namespace lacuna::io::laz
