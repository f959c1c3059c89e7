// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "equilibria/new_modules.hpp"

#include "dense.hpp"

namespace holdfast::plan {
namespace {

using base::at;
using base::Mat6;
using base::Vec6;

Mat6<double> transposed(const Mat6<double>& a) {
  Mat6<double> t;
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < 6; ++k) {
      t.at(k, i) = a.at(i, k);
    }
  }
  return t;
}

Mat6<double> product(const Mat6<double>& a, const Mat6<double>& b) {
  return base::matrix_of<double>(
      [&](const Vec6<double>& unit) { return base::multiply(a, base::multiply(b, unit)); });
}

Vec6<double> negative(const Vec6<double>& a) { return base::sum_of<double>({}, -1, a); }

}  // namespace

NewModules::NewModules(const SolvedCore& core, std::span<const Link> links,
                       std::span<const model::Connection> beams, std::span<const Vec> loads,
                       std::span<const solver::FacetState> facets)
    : has_facet_(!facets.empty()), loads_(loads.begin(), loads.end()) {
  const std::size_t count = loads.size();
  const model::LatticeBeam<double>& beam = core.beam();
  std::vector<Mat> stiffness(count * count);
  for (const Link& link : links) {
    to_.push_back(link.to);
    own_.push_back(beam.block_11(link.direction));
    coupling_.push_back(beam.block_12(link.direction));
    base::add_to(stiffness[link.to * count + link.to],
                 beam.block_11(base::opposite(link.direction)));
  }
  for (const model::Connection& pair : beams) {
    const base::Direction back = base::opposite(pair.direction);
    base::add_to(stiffness[at(pair.a) * count + at(pair.a)], beam.block_11(pair.direction));
    base::add_to(stiffness[at(pair.b) * count + at(pair.b)], beam.block_11(back));
    base::add_to(stiffness[at(pair.a) * count + at(pair.b)], beam.block_12(pair.direction));
    base::add_to(stiffness[at(pair.b) * count + at(pair.a)], beam.block_12(back));
  }
  for (const solver::FacetState& facet : facets) {
    base::add_to(stiffness[facet.module * count + facet.module], core.law().tangent(facet));
  }
  inverse_ = inverse_of(stiffness, count);
  const std::vector<Vec> alone = displacements({});
  for (std::size_t i = 0; i < links.size(); ++i) {
    link_loads_.push_back(negative(base::multiply(coupling_[i], alone[to_[i]])));
  }
}

base::Mat6<double> NewModules::stiffness(std::size_t link_i, std::size_t link_j) const {
  Mat c = product(coupling_[link_i],
                  product(inverse(to_[link_i], to_[link_j]), transposed(coupling_[link_j])));
  for (double& value : c.values) {
    value = -value;
  }
  if (link_i == link_j) {
    base::add_to(c, own_[link_i]);
  }
  return c;
}

std::vector<base::Vec6<double>> NewModules::displacements(std::span<const Vec> hosts) const {
  std::vector<Vec> forces = loads_;
  for (std::size_t i = 0; i < hosts.size(); ++i) {
    base::add_to(forces[to_[i]], negative(base::multiply(transposed(coupling_[i]), hosts[i])));
  }
  std::vector<Vec> moved(loads_.size());
  for (std::size_t row = 0; row < moved.size(); ++row) {
    for (std::size_t column = 0; column < moved.size(); ++column) {
      base::add_to(moved[row], base::multiply(inverse(row, column), forces[column]));
    }
  }
  return moved;
}

}  // namespace holdfast::plan
