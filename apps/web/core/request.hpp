// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "holdfast/trial.hpp"

/// Reads the page's requests, which are bytes. src/core/wasm.ts writes them; both sides must agree.
namespace holdfast::web {

inline constexpr std::size_t kOptionCount = 7;
inline constexpr std::size_t kMaterialCount = model::kMaterialParameters.size();

/// Little-endian, this object, then `module_count` PlacedModule, then `more_size` bytes of text and
/// up to three more to a whole word, then a tail of bytes whose meaning depends on the call.
struct RequestHeader {
  std::int32_t module_count = 0;
  std::int32_t support_z = 0;  ///< Void without a floor.
  std::int32_t more_size = 0;
  std::array<std::int32_t, kOptionCount> options{};
  std::array<double, kMaterialCount> material{};  ///< As kMaterialParameters.
};

struct PlacedModule {
  base::Cell cell;
  std::int32_t role_index = 0;

  Role role() const { return static_cast<Role>(role_index); }
};

/// Views into the bytes of a request.
struct Request {
  RequestHeader header;
  std::span<const PlacedModule> modules;
  /// The rest of a structure beside cells and material, as holdfast JSON whose modules are those
  /// that have something of their own; empty for cubes on a floor under their own weight.
  std::string_view more;
  std::span<const std::uint8_t> tail;
};

Request read_request(std::span<const std::uint8_t> bytes);

model::Material material_of(const RequestHeader& header);
std::array<double, kMaterialCount> numbers_of(const model::Material& material);

/// Makes what mechanics must know, which Robot::create checks. Errors: those of io::read_json and
/// io::make_spec.
base::Result<model::RobotSpec> spec_of(const Request& request);

/// Two modules of the robot or of the step that is planned first are in one cell.
bool has_double_cell(const io::Document& document);

/// The document that the page's modules are when everything else is as in `base`: what a file said
/// about a module, its colour and attributes, stays with its cell. Errors: those of io::read_json.
base::Result<io::Document> edited(const io::Document& base, const Request& request);

/// The text for Request::more of a document that was opened.
std::string more_of(const io::Document& document);

}  // namespace holdfast::web
