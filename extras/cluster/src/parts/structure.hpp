// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "holdfast/base/cell.hpp"
#include "holdfast/base/result.hpp"
#include "holdfast/io/binary_structure.hpp"
#include "holdfast/io/document.hpp"
#include "holdfast/model/robot.hpp"
#include "ranks/petsc_ranks.hpp"

/// A structure of which each rank has a part: modules along the Morton curve.
namespace holdfast::cluster {

/// A module, in files and between ranks.
using Record = io::ModuleRecord;

/// A rank's part of a structure.
struct Structure {
  std::string name;
  model::RobotSpec common;  ///< Without modules: all ranks have the same.
  /// This rank's modules, along the curve; at least one, if there are as many modules as ranks.
  std::vector<Record> records;
  base::Cell low;  ///< The whole robot's lowest corner, in bricks.
  std::vector<std::string> warnings;
  /// A number that identifies the whole structure, on however many ranks.
  std::uint64_t fingerprint = 0;
};

/// Reads a structure: a binary one by all ranks, each its part; XML or JSON by the first rank,
/// which hands out the parts. All ranks return the same error.
base::Result<Structure> read_structure(PetscRanks& ranks, const std::string& file,
                                       const io::ReadOptions& options);

/// Writes a document as a binary structure (docs/formats.md); called by one rank.
base::Result<std::size_t> write_binary(const io::Document& document, const std::string& file);

}  // namespace holdfast::cluster
