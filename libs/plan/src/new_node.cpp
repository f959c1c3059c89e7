// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "new_node.hpp"

#include "dense.hpp"
#include "holdfast/base/check.hpp"

namespace holdfast::plan {
namespace {

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

Mat6<double> inverse(const Mat6<double>& a) {
  DenseSystem system(6);
  for (std::size_t i = 0; i < 6; ++i) {
    for (std::size_t k = 0; k < 6; ++k) {
      system.at(i, k) = a.at(static_cast<int>(i), static_cast<int>(k));
    }
  }
  HOLDFAST_CHECK(system.factor());
  return base::matrix_of<double>([&](Vec6<double> unit) {
    system.solve(unit);
    return unit;
  });
}

}  // namespace

NewNode::NewNode(const solver::Influence& influence, const Site& site, const Vec& load,
                 const solver::FacetState* own)
    : has_facet_(own != nullptr), load_(load) {
  const model::LatticeBeam<double>& beam = influence.beam();
  Mat stiffness;
  for (const Link& link : site.links) {
    own_.push_back(beam.block_11(link.direction));
    coupling_.push_back(beam.block_12(link.direction));
    base::add_to(stiffness, beam.block_11(base::opposite(link.direction)));
  }
  if (own != nullptr) {
    base::add_to(stiffness, influence.law().tangent(*own));
  }
  inverse_ = inverse(stiffness);
  const Vec alone = base::multiply(inverse_, load_);
  for (const Mat& coupling : coupling_) {
    Vec q = base::multiply(coupling, alone);
    for (double& value : q) {
      value = -value;
    }
    loads_.push_back(q);
  }
}

base::Mat6<double> NewNode::stiffness(std::size_t host_i, std::size_t host_j) const {
  Mat c = product(coupling_[host_i], product(inverse_, transposed(coupling_[host_j])));
  for (double& value : c.values) {
    value = -value;
  }
  if (host_i == host_j) {
    base::add_to(c, own_[host_i]);
  }
  return c;
}

base::Vec6<double> NewNode::displacement(std::span<const Vec> hosts) const {
  Vec force = load_;
  for (std::size_t i = 0; i < hosts.size(); ++i) {
    const Vec pull = base::multiply(transposed(coupling_[i]), hosts[i]);
    for (std::size_t k = 0; k < 6; ++k) {
      force[k] -= pull[k];
    }
  }
  return base::multiply(inverse_, force);
}

}  // namespace holdfast::plan
