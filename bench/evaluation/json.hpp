// SPDX-License-Identifier: Apache-2.0
// The parts that the JSON of `lacuna-bench evaluate` and that of `lacuna-bench score` share.
#pragma once

#include "bench/evaluation/boundary_points.hpp"
#include "io/write/loops/json.hpp"

#include <optional>

namespace lacuna::evaluation {

using io::Json;

template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json();
}

inline Json json_of(const PointScores& scores) {
  return {{"precision", or_null(scores.precision)},
          {"recall", or_null(scores.recall)},
          {"f1", or_null(scores.f1)}};
}

}  // namespace lacuna::evaluation
