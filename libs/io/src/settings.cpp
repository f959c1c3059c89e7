// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "settings.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <iterator>

#include "holdfast/io/near_miss.hpp"
#include "holdfast/io/report.hpp"
#include "json/json_connectors.hpp"
#include "numbers.hpp"
#include "reading.hpp"
#include "text_input.hpp"
#include "vocabulary.hpp"

namespace holdfast::io {
namespace {

constexpr std::string_view kMaterialPrefix = "material.";

bool is_connector_key(std::string_view key) {
  return key != kBendingKey && std::ranges::find(kConnectorKeys, key) != kConnectorKeys.end();
}

/// The member of a scatter that a key sets; null if it sets none.
std::optional<double> Scatter::*cv_of(std::string_view key) {
  return key == kScatterKeys[0]   ? &Scatter::strength_cv
         : key == kScatterKeys[1] ? &Scatter::mass_cv
                                  : nullptr;
}

bool is_class_strength(std::string_view key) {
  return std::ranges::find(kClassStrengthKeys, key) != kClassStrengthKeys.end();
}

base::Error unknown_key(std::string_view key) {
  std::vector<std::string_view> names;
  std::ranges::copy_if(kConnectorKeys, std::back_inserter(names), is_connector_key);
  for (const model::MaterialParameter& parameter : model::kMaterialParameters) {
    names.push_back(parameter.key);
  }
  names.insert(names.end(), kKindScatterKeys.begin(), kKindScatterKeys.end());
  const auto near = near_miss(key, names);
  return base::bad_input(fmt::format(
      "a material has no '{}'{}", one_line(key),
      near ? "; " + did_you_mean(*near) : fmt::format("; it has {}", fmt::join(names, ", "))));
}

}  // namespace

base::Result<Setting> find_setting(std::string_view text) {
  const std::size_t mark = text.find('=');
  const auto value =
      mark == std::string_view::npos ? std::nullopt : parse_number<double>(text.substr(mark + 1));
  if (!value) {
    return base::bad_input(
        fmt::format("expected KEY=NUMBER, such as strength_lateral_n=12, found {}", excerpt(text)));
  }
  std::string_view key = text.substr(0, mark);
  key.remove_prefix(key.starts_with(kMaterialPrefix) ? kMaterialPrefix.size() : 0);
  if (const model::MaterialParameter* const parameter = model::find_parameter(key)) {
    if (auto fault = model::find_fault(*parameter, *value)) {
      return base::bad_input(*std::move(fault));
    }
  } else if (cv_of(key) != nullptr) {
    if (auto fault = find_cv_fault(key, *value)) {
      return base::bad_input(*std::move(fault));
    }
  } else if (!is_connector_key(key)) {
    return unknown_key(key);
  } else if (*value < kPositiveMin) {
    return base::bad_input(
        fmt::format("{}: expected a number of {} and more, found {}", key, kPositiveMin, *value));
  }
  return Setting{.key = std::string(key), .value = *value};
}

base::Result<SupportLevel> find_support_level(std::string_view text) {
  if (text == "lowest") {
    return SupportLevel{};
  }
  const auto z = parse_number<std::int32_t>(text);
  if (!z || !kCoordinateRange.contains(*z)) {
    return base::bad_input(
        fmt::format("expected lowest or an integer from {} to {}, the z of a layer, found {}",
                    kCoordinateRange.lowest, kCoordinateRange.highest, excerpt(text)));
  }
  return SupportLevel{*z};
}

std::optional<std::string> take_setting(const Setting& setting, Document& document) {
  auto& parameters = document.extension.connectors.parameters;
  const auto is_key = [](std::string_view key) {
    return [key](const ConnectorParameter& one) { return one.key == key; };
  };
  if (is_class_strength(setting.key) && std::ranges::any_of(parameters, is_key(kStrengthKey))) {
    return fmt::format("{} cannot be set, as the file gives {} for all connections", setting.key,
                       kStrengthKey);
  }
  if (const model::MaterialParameter* const parameter = model::find_parameter(setting.key)) {
    take_number(*parameter, setting.value, document);
    if (parameter->value == &model::Material::pitch_mm) {
      document.extension.pitch_mm.reset();  // One number for all directions.
    }
    return std::nullopt;
  }
  if (const auto cv = cv_of(setting.key)) {
    document.extension.scatter.*cv = setting.value;
    return std::nullopt;
  }
  std::erase_if(parameters, is_key(setting.key));
  if (setting.key == kStrengthKey) {
    document.material.strength_vertical_n = setting.value;
    document.material.strength_lateral_n = setting.value;
  } else {
    parameters.push_back({setting.key, Spread::kAll, {setting.value}});
  }
  return std::nullopt;
}

}  // namespace holdfast::io
