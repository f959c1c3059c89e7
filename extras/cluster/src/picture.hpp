// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "holdfast/base/result.hpp"
#include "holdfast/model/robot.hpp"
#include "holdfast/verdict/assessment.hpp"

namespace holdfast::cluster {

/// The piece of a robot that a rank shows: its first modules, `own_count` of them.
struct Piece {
  const model::Robot* robot = nullptr;
  std::size_t own_count = 0;
  int rank = 0;
  int rank_count = 1;
};

/// Says why ParaView's file cannot have this name; none if it can.
std::optional<std::string> find_name_fault(const std::string& file);

/// Writes a rank's piece for ParaView beside NAME.pvtu, NAME_RANK.vtu; the first rank writes
/// NAME.pvtu as well. Called by each rank, or by one alone.
std::optional<base::Error> write_piece(const std::string& file, const Piece& piece,
                                       const verdict::Assessment& assessment);

}  // namespace holdfast::cluster
