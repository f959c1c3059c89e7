// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "holdfast/move.hpp"
#include "reading.hpp"

/// The cells that a plan avoids, and the modules that it keeps.
namespace holdfast::cli {

/// The texts of --avoid and --keep.
struct PlanCells {
  std::vector<std::string> avoid;  ///< Cells and boxes.
  std::vector<std::string> keep;   ///< And files.

  /// The files among what is kept.
  std::vector<std::string> files() const;
};

void add_plan_cells(CLI::App& command, PlanCells& cells, const std::string& avoid_help);

/// All cells to be avoided.
std::vector<base::Cell> avoided_cells(const PlanCells& cells);

/// Adds to `kept` what is to be kept of a robot; false if a file cannot be taken, which it says.
bool take_kept(const PlanCells& cells, const Reading& reading, const model::RobotSpec& robot,
               std::vector<plan::CellBox>& kept);

/// The cells of a file that stands for modules of a robot. A note names what else differs. Errors:
/// it cannot be read, has steps, or another lattice.
base::Result<std::vector<base::Cell>> cells_of_file(const std::string& file, const Reading& reading,
                                                    const model::RobotSpec& robot);

}  // namespace holdfast::cli
