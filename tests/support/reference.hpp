// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <fstream>
#include <istream>
#include <string>
#include <utility>
#include <vector>

#include "holdfast/verdict/assessment.hpp"

/// Structures whose loads were computed independently of this project.
namespace holdfast::test {

struct ReferenceLoad {
  base::Cell a;
  base::Cell b;
  verdict::ConnectionResult result;
};

struct Reference {
  std::string name;
  model::RobotSpec spec;
  bool is_settled = false;
  bool is_stable = false;
  bool is_tie = false;
  double margin_mm = 0;
  std::vector<ReferenceLoad> loads;
};

inline std::vector<base::Cell> read_cells(std::istream& line, std::size_t count) {
  std::vector<base::Cell> cells(count);
  char comma = 0;
  for (base::Cell& cell : cells) {
    line >> cell.x >> comma >> cell.y >> comma >> cell.z;
  }
  return cells;
}

/// All that are in tests/reference/structures.txt; its README says what the numbers are.
inline std::vector<Reference> read_references(const char* path) {
  std::ifstream file(path);
  std::vector<Reference> references;
  std::string keyword;
  while (file >> keyword) {
    Reference reference;
    std::size_t existing = 0;
    std::size_t planned = 0;
    std::size_t connections = 0;
    file >> reference.name >> existing >> planned >> connections >> reference.is_settled >>
        reference.is_stable >> reference.is_tie >> reference.margin_mm;
    const std::vector<base::Cell> cells = read_cells(file, existing + planned);
    reference.spec.existing.assign(cells.begin(),
                                   cells.begin() + static_cast<std::ptrdiff_t>(existing));
    reference.spec.planned.assign(cells.begin() + static_cast<std::ptrdiff_t>(existing),
                                  cells.end());
    for (std::size_t i = 0; i < connections; ++i) {
      std::size_t a = 0;
      std::size_t b = 0;
      ReferenceLoad load;
      file >> a >> b >> load.result.load_ratio >> load.result.axial_n >> load.result.bending_nmm;
      load.a = std::min(cells.at(a), cells.at(b));
      load.b = std::max(cells.at(a), cells.at(b));
      reference.loads.push_back(load);
    }
    references.push_back(std::move(reference));
  }
  return references;
}

}  // namespace holdfast::test
