// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/frames/growing_network.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "holdfast/base/check.hpp"

namespace holdfast::frames {
namespace {

using base::at;
using base::Vec6;

std::vector<solver::Edge> edges(const SpringNetwork& network) {
  std::vector<solver::Edge> edges;
  for (const LoadedSpring& element : network.elements) {
    if (element.spring.a != kGround) {
      edges.push_back({element.spring.a, element.spring.b});
    }
  }
  return edges;
}

bool is_of_ground(const LoadedSpring& element) { return element.spring.b == kGround; }

Vec6<double> transposed_product(const base::Mat6<double>& a, const Vec6<double>& x) {
  Vec6<double> y{};
  for (std::size_t column = 0; column < 6; ++column) {
    for (std::size_t row = 0; row < 6; ++row) {
      y[column] += a.values[6 * column + row] * x[row];
    }
  }
  return y;
}

}  // namespace

GrowingNetwork::GrowingNetwork(const SpringNetwork& network)
    : network_(&network),
      factor_(network.node_count, edges(network)),
      has_element_(network.elements.size(), 0),
      loads_(network.node_count),
      solution_(network.node_count),
      residual_(network.node_count) {
  for (const LoadedSpring& element : network.elements) {
    for (const double value : element.spring.lever.values) {
      arm_mm_ = std::max(arm_mm_, std::abs(value));
    }
  }
}

bool GrowingNetwork::can_be_added(std::size_t element) const {
  const LowRankTerm& spring = network_->elements[element].spring;
  return !has_element(element) && (has_node(spring.a) || has_node(spring.b));
}

void GrowingNetwork::load(std::size_t e, double sign) {
  const LoadedSpring& element = network_->elements[e];
  const auto put = [&](std::int32_t node, const Vec6<double>& load) {
    if (node != kGround) {
      base::add_times(loads_[at(node)], sign, load);
    }
  };
  put(element.spring.a, element.load_a);
  put(element.spring.b, element.load_b);
  has_element_[e] = sign > 0 ? 1 : 0;
  element_count_ = sign > 0 ? element_count_ + 1 : element_count_ - 1;
  is_solved_ = false;
}

void GrowingNetwork::add_load(std::size_t node, const Vec6<double>& load) {
  base::add_to(loads_[node], load);
  is_solved_ = false;
}

bool GrowingNetwork::add(std::size_t e) {
  HOLDFAST_CHECK(!has_element(e));
  const LoadedSpring& element = network_->elements[e];
  if (!is_of_ground(element) && !factor_.add(element.spring)) {
    return false;
  }
  load(e, 1);
  last_element_ = e;
  last_sign_ = 1;
  return true;
}

bool GrowingNetwork::remove(std::size_t e) {
  HOLDFAST_CHECK(has_element(e));
  const LoadedSpring& element = network_->elements[e];
  if (!is_of_ground(element) && !factor_.remove(element.spring)) {
    return false;
  }
  load(e, -1);
  last_element_ = e;
  last_sign_ = -1;
  return true;
}

void GrowingNetwork::undo() {
  HOLDFAST_CHECK(last_sign_ != 0);
  if (!is_of_ground(network_->elements[last_element_])) {
    factor_.undo();
  }
  load(last_element_, -last_sign_);
  last_sign_ = 0;
}

bool GrowingNetwork::assign(std::span<const std::size_t> elements) {
  std::ranges::fill(has_element_, std::uint8_t{0});
  std::ranges::fill(loads_, Vec6<double>{});
  element_count_ = 0;
  is_solved_ = false;
  last_sign_ = 0;
  std::vector<const LowRankTerm*> terms;
  for (const std::size_t e : elements) {
    load(e, 1);
    if (!is_of_ground(network_->elements[e])) {
      terms.push_back(&network_->elements[e].spring);
    }
  }
  return factor_.factor(terms);
}

/// residual_ = loads - K u. Returns its largest component, of the sum of loads.
double GrowingNetwork::make_residual(const std::vector<Vec6<double>>& u) {
  residual_ = loads_;
  for (std::size_t e = 0; e < has_element_.size(); ++e) {
    const LowRankTerm& spring = network_->elements[e].spring;
    if (!has_element(e) || spring.b == kGround) {
      continue;
    }
    Vec6<double> strain = u[at(spring.b)];
    if (spring.a != kGround) {
      base::add_to(strain, transposed_product(spring.lever, u[at(spring.a)]));
    }
    Vec6<double> force = base::multiply(spring.stiffness, strain);
    for (double& value : force) {
      value = -value;
    }
    base::add_to(residual_[at(spring.b)], force);
    if (spring.a != kGround) {
      base::add_to(residual_[at(spring.a)], base::multiply(spring.lever, force));
    }
  }
  double load_sum = 0;
  for (const Vec6<double>& load : loads_) {
    load_sum += std::hypot(load[0], load[1], load[2]);
  }
  double largest = 0;
  for (const Vec6<double>& r : residual_) {
    for (std::size_t i = 0; i < 6; ++i) {
      const double size = std::abs(r[i]) / (i < 3 ? 1 : arm_mm_);
      largest = size <= largest ? largest : size;  // NaN is largest.
    }
  }
  return load_sum > 0 ? largest / load_sum : 0;
}

/// Newton's method on linear equations: what the residual alone would move, twice at most.
bool GrowingNetwork::refine() {
  for (int step = 0; step < 3; ++step) {
    const double residual = make_residual(solution_);
    if (residual <= kResidualMax) {
      return true;
    }
    if (step == 2 || !std::isfinite(residual)) {
      return false;
    }
    factor_.solve(residual_);
    ++work_.solution_count;
    ++work_.refinement_count;
    for (std::size_t node = 0; node < solution_.size(); ++node) {
      base::add_to(solution_[node], residual_[node]);
    }
  }
  return false;
}

const std::vector<Vec6<double>>& GrowingNetwork::displacements() {
  static const std::vector<Vec6<double>> kNone;
  if (is_solved_) {
    return solution_;
  }
  for (const bool is_anew : {false, true}) {
    if (is_anew) {
      std::vector<const LowRankTerm*> terms;
      for (std::size_t e = 0; e < has_element_.size(); ++e) {
        if (has_element(e) && !is_of_ground(network_->elements[e])) {
          terms.push_back(&network_->elements[e].spring);
        }
      }
      ++work_.factorization_count;
      last_sign_ = 0;
      if (!factor_.factor(terms)) {
        return kNone;
      }
    }
    solution_ = loads_;
    factor_.solve(solution_);
    ++work_.solution_count;
    if (refine()) {
      is_solved_ = true;
      return solution_;
    }
  }
  return kNone;
}

double GrowingNetwork::translation_max() {
  const std::vector<Vec6<double>>& u = displacements();
  if (u.empty() && network_->node_count > 0) {
    return std::numeric_limits<double>::infinity();
  }
  double largest = 0;
  for (const Vec6<double>& node : u) {
    largest = std::max(largest, node[0] * node[0] + node[1] * node[1] + node[2] * node[2]);
  }
  return std::sqrt(largest);
}

}  // namespace holdfast::frames
