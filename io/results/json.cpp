#include "io/results/json.hpp"

#include <variant>

namespace lacuna::io {
namespace {

template <class Value>
Json json_value(const Value* value) {
  return *value;
}
Json json_value(const NamedValue& value) {
  return value.names[*value.value];
}

}  // namespace

Json begin_json(std::string_view schema) {
  return {{"lacuna", LACUNA_VERSION}, {"schema", schema}};
}

std::string print(const Json& json, int indent) {
  return json.dump(indent, ' ', false, Json::error_handler_t::replace);
}

Json list(const Eigen::Vector3d& vector) {
  return Json::array({vector.x(), vector.y(), vector.z()});
}

Json counts_of(const FilteredOut& filtered) {
  return {{"origin", filtered.origin},
          {"bounds", filtered.bounds},
          {"classes", filtered.classes},
          {"returns", filtered.returns}};
}

Json parameter_values(Config config, const std::function<bool(std::string_view section)>& is_wanted) {
  Json sections = Json::object();
  for (const Parameter& parameter : parameters(config)) {
    if (!is_wanted(parameter.section)) continue;
    Json& entry = sections[std::string(parameter.section)][std::string(parameter.key)];
    std::visit([&](const auto& value) { entry = json_value(value); }, parameter.value);
  }
  return sections;
}

}  // namespace lacuna::io
