// SPDX-License-Identifier: Apache-2.0
// The parts that the JSON of `lacuna-bench evaluate` and that of `lacuna-bench score` share.
#pragma once

#include "bench/evaluation/boundary_points.hpp"

#include <optional>
#include <string>

#include <nlohmann/json.hpp>

namespace lacuna::evaluation {

using Json = nlohmann::ordered_json;

template <class T>
Json or_null(const std::optional<T>& value) {
  return value ? Json(*value) : Json();
}

inline Json json_of(const PointScores& scores) {
  return {{"precision", or_null(scores.precision)},
          {"recall", or_null(scores.recall)},
          {"f1", or_null(scores.f1)}};
}

// Names of files need not be UTF-8.
inline std::string text_of(const Json& root) {
  return root.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace lacuna::evaluation
