// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "holdfast/distributed.hpp"
#include "holdfast/weakened.hpp"

/// Faults and changes as they are written on the command line: "X,Y,Z@T", at a face "X,Y,Z:+x@T".
namespace holdfast::cli {

struct FaultPlace {
  base::Cell cell;
  std::int32_t module = -1;  ///< The existing one in the cell; -1 if there is none.
  base::Direction face = base::Direction::kPlusX;
  double time = 0;
};

/// Reads the place of a fault; none if the text is no cell and time.
std::optional<FaultPlace> read_fault_place(std::string_view text, bool has_face,
                                           const Structure& structure);

/// The cell and time of a change; "all@T" is agent::kEveryCell if `allows_all`.
struct ChangePlace {
  base::Cell cell;
  double time = 0;
};

std::optional<ChangePlace> read_change_place(std::string_view text, bool allows_all);

/// Says what is wrong with a text that is no such place.
std::string change_usage(std::string_view option, std::string_view text, bool allows_all);
std::string fault_usage(std::string_view option, std::string_view text, bool has_face);
std::string no_module(std::string_view option, std::string_view text, const base::Cell& cell);

/// Reads "X,Y,Z:FACE=SHARE", a share above 0 and up to 1; none if the text is something else.
std::optional<Weakening> read_weakening(std::string_view text);

/// Says how --weaken is used.
std::string weakening_usage(std::string_view text);

}  // namespace holdfast::cli
