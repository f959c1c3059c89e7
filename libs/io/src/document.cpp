// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/io/document.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "formats/foreign_reading.hpp"
#include "holdfast/io/binary_structure.hpp"
#include "holdfast/io/foreign_format.hpp"
#include "text_input.hpp"

namespace holdfast::io {

void take_number(const model::MaterialParameter& parameter, double value, Document& document) {
  document.material.*parameter.value = value;
  if (parameter.value == &model::Material::elastic_modulus_mpa) {
    document.is_default_modulus_stated = value == model::Material{}.elastic_modulus_mpa;
  }
}

bool is_said(const model::MaterialParameter& parameter, const model::Material& defaults,
             const Document& document) {
  return document.material.*parameter.value != defaults.*parameter.value ||
         (parameter.value == &model::Material::elastic_modulus_mpa &&
          document.is_default_modulus_stated);
}

base::Result<Format> detect_format(std::string_view text) {
  if (text.starts_with(kBinaryMagic)) {
    return Format::kBinary;
  }
  text = trimmed(without_bom(text));
  if (text.starts_with('<')) {
    return Format::kVisibleSimXml;
  }
  if (text.starts_with('{') || text.starts_with('[')) {
    return Format::kJson;
  }
  if (text.empty()) {
    return base::Error{base::ErrorCode::kBadInput, "expected a structure, found an empty input",
                       ""};
  }
  return base::Error{
      base::ErrorCode::kBadInput,
      fmt::format("expected holdfast JSON such as {}, VisibleSim XML, which begins with '<', or "
                  "binary, with HOLDFAST; found {} at the beginning{}",
                  kLeastJson, excerpt(text.substr(0, 8)),
                  text.starts_with('/') || text.starts_with('#') ? "; JSON has no comments" : ""),
      ""};
}

namespace {

/// Puts the robot on the layer that an option says.
base::Result<ReadDocument> with_support(base::Result<ReadDocument> read,
                                        const ReadOptions& options) {
  if (!read || !options.support || read.value().document.modules.empty()) {
    return read;
  }
  auto [document, warnings] = std::move(read).value();
  if (!document.extension.has_floor) {
    return base::bad_input("the structure has no floor, whose level an option asks for");
  }
  const auto lowest = std::ranges::min_element(
      document.modules, {}, [](const ModuleEntry& module) { return module.cell.z; });
  document.support_z = options.support->z.value_or(lowest->cell.z);
  warnings.push_back(
      fmt::format("the support level is set to z = {} by an option", document.support_z));
  return ReadDocument{std::move(document), std::move(warnings)};
}

/// Takes the safety factor that an option says, and says what it is.
base::Result<ReadDocument> with_factor(base::Result<ReadDocument> read,
                                       const ReadOptions& options) {
  if (!read) {
    return read;
  }
  auto [document, warnings] = std::move(read).value();
  const double stated = document.extension.safety_factor;
  const double factor = options.safety_factor.value_or(stated);
  document.extension.safety_factor = factor;
  const std::string other =
      stated != 1 && factor != stated ? fmt::format(" in place of the file's {}", stated) : "";
  if (factor != 1) {
    warnings.push_back(
        fmt::format("strengths are divided by {}, the safety factor{}, and load ratios refer to "
                    "what is left",
                    factor, other));
  } else if (!other.empty()) {
    warnings.push_back(fmt::format("the safety factor is set to 1{} by an option", other));
  }
  return ReadDocument{std::move(document), std::move(warnings)};
}

base::Result<ReadDocument> read_any(std::string_view text, const ReadOptions& options) {
  const auto* const foreign =
      text.starts_with(kBinaryMagic) ? nullptr : find_foreign_format(text, options.ending);
  if (options.palette && !is_vox(text, options.ending)) {
    return base::bad_input("a palette is given, expected a file of MagicaVoxel (.vox)");
  }
  if (foreign != nullptr) {
    return read_foreign(*foreign, text, options);
  }
  const auto format = detect_format(text);
  if (!format) {
    return format.error();
  }
  switch (format.value()) {
    case Format::kVisibleSimXml:
      return read_visiblesim(text, options);
    case Format::kJson:
      return read_json(text, options);
    case Format::kBinary:
      break;
  }
  return read_binary(text, options);
}

}  // namespace

base::Result<ReadDocument> read_document(std::string_view text, const ReadOptions& options) {
  auto read = with_factor(with_support(read_any(text, options), options), options);
  if (!read) {
    return read;
  }
  ReadDocument document = std::move(read).value();
  document.document.may_be_in_pieces = options.may_be_in_pieces;
  document.document.is_lattice_chosen = options.lattice.has_value();
  return document;
}

}  // namespace holdfast::io
