// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "facet_influence.hpp"

#include "holdfast/base/algebra.hpp"

namespace holdfast::plan {

using base::Vec6;
using solver::kLaneCount;

std::unique_ptr<FacetInfluence> FacetInfluence::make(const solver::Influence& influence,
                                                     std::size_t memory_bytes_max) {
  const std::size_t facet_count = influence.facets().size();
  const std::size_t module_count = influence.displacement().size();
  const std::size_t vectors = 6 * facet_count * (module_count + facet_count);
  if (vectors > memory_bytes_max / sizeof(Vec)) {
    return nullptr;
  }
  std::unique_ptr<FacetInfluence> facets(new FacetInfluence());
  for (const solver::FacetState& facet : influence.facets()) {
    auto& rows = facets->rows_.emplace_back();
    const Vec& stiffness = influence.law().ground().stiffness;
    for (int k = 0; k < 6; ++k) {
      const Vec trial = influence.law().trial_force(facet, base::unit<double>(k));
      for (std::size_t i = 0; i < 6; ++i) {
        rows[i][static_cast<std::size_t>(k)] = trial[i] / stiffness[i];
      }
    }
  }
  facets->columns_.resize(6 * facet_count * module_count);
  facets->solve(influence);
  return facets;
}

void FacetInfluence::solve(const solver::Influence& influence) {
  const std::size_t count = 6 * rows_.size();
  const std::size_t module_count = influence.displacement().size();
  std::vector<solver::LaneBlock> lanes;
  for (std::size_t first = 0; first < count; first += kLaneCount) {
    lanes.assign(influence.slot_count(), {});
    const std::size_t lane_count = count - first < kLaneCount ? count - first : kLaneCount;
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      const std::size_t facet = (first + lane) / 6;
      const Vec& load = rows_[facet][(first + lane) % 6];
      solver::LaneBlock& block = lanes[influence.slot(influence.facets()[facet].module)];
      for (std::size_t k = 0; k < 6; ++k) {
        block.values[k][lane] = load[k];
      }
    }
    influence.solve(lanes);
    for (std::size_t module = 0; module < module_count; ++module) {
      const solver::LaneBlock& block = lanes[influence.slot(module)];
      for (std::size_t lane = 0; lane < lane_count; ++lane) {
        for (std::size_t k = 0; k < 6; ++k) {
          columns_[module * count + first + lane][k] = block.values[k][lane];
        }
      }
    }
  }
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const std::size_t module = influence.facets()[i].module;
    for (std::size_t j = 0; j < rows_.size(); ++j) {
      Mat& block = between_.emplace_back();
      for (std::size_t k = 0; k < 6; ++k) {
        const Vec moved = motion(i, displacement(module, j, k));
        for (std::size_t row = 0; row < 6; ++row) {
          block.values[6 * k + row] = moved[row];
        }
      }
    }
  }
}

Vec6<double> FacetInfluence::motion(std::size_t facet, const Vec& u) const {
  Vec w{};
  for (std::size_t i = 0; i < 6; ++i) {
    w[i] = base::dot(rows_[facet][i], u);
  }
  return w;
}

Vec6<double> FacetInfluence::load(std::size_t facet, const Vec& forces) const {
  Vec load{};
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t k = 0; k < 6; ++k) {
      load[k] += forces[i] * rows_[facet][i][k];
    }
  }
  return load;
}

}  // namespace holdfast::plan
