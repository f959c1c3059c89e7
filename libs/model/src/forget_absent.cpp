// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "holdfast/model/robot.hpp"

namespace holdfast::model {
namespace {

/// Knows in which cells a spec has modules.
class Absence {
 public:
  explicit Absence(const RobotSpec& spec) : there_(spec.existing) {
    there_.insert(there_.end(), spec.planned.begin(), spec.planned.end());
    std::ranges::sort(there_);
  }

  bool operator()(const base::Cell& cell) const {
    return !std::ranges::binary_search(there_, cell);
  }

  bool operator()(const CellPair& pair) const { return (*this)(pair[0]) || (*this)(pair[1]); }

 private:
  std::vector<base::Cell> there_;
};

void forget_absent_pairs(const Absence& is_absent, RobotSpec& spec) {
  std::erase_if(spec.released, is_absent);
  std::erase_if(spec.own_connectors,
                [&](const OwnConnector& own) { return is_absent(own.between); });
}

}  // namespace

void forget_absent_pairs(RobotSpec& spec) {
  if (!spec.released.empty() || !spec.own_connectors.empty()) {
    forget_absent_pairs(Absence(spec), spec);
  }
}

void forget_absent(RobotSpec& spec) {
  if (spec.fixed.empty() && spec.released.empty() && spec.own_kinds.empty() &&
      spec.own_masses.empty() && spec.own_connectors.empty() && spec.payloads.empty() &&
      spec.lost_facets.empty()) {
    return;
  }
  const Absence is_absent(spec);
  forget_absent_pairs(is_absent, spec);
  const auto is_of_absent = [&](const auto& own) { return is_absent(own.cell); };
  std::erase_if(spec.fixed, is_absent);
  std::erase_if(spec.own_kinds, is_of_absent);
  std::erase_if(spec.own_masses, is_of_absent);
  std::erase_if(spec.payloads, is_of_absent);
  std::erase_if(spec.lost_facets, is_of_absent);
}

}  // namespace holdfast::model
