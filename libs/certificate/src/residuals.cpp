// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "balance.hpp"

namespace holdfast::certificate {

struct Residuals::Parts {
  explicit Parts(const Certificate& made)
      : certificate(made),
        structure(made),
        constants(made.material),
        balancer(made, structure, constants) {}

  const Certificate& certificate;
  Structure structure;
  Constants constants;
  Balancer balancer;
};

Residuals::Residuals(const Certificate& certificate)
    : parts_(std::make_unique<Parts>(certificate)) {}

Residuals::~Residuals() = default;

Residual Residuals::of(std::size_t field) const {
  const Balance balance = parts_->balancer.from_springs(field);
  const std::vector<Module>& modules = parts_->certificate.modules;
  Residual result;
  result.force.resize(modules.size());
  for (std::size_t i = 0; i < modules.size(); ++i) {
    for (std::size_t k = 0; k < 6 && !modules[i].is_fixed; ++k) {
      const auto force = static_cast<double>(balance.rest[i][k]);
      result.force[i][k] = force;
      result.largest = std::max(result.largest, std::abs(force));
    }
  }
  double carried = 0;
  for (const Six& s : balance.beam) {
    for (const Integer force : s) {
      carried = std::max(carried, std::abs(static_cast<double>(force)));
    }
  }
  result.rounding = carried * std::numeric_limits<double>::epsilon();
  return result;
}

}  // namespace holdfast::certificate
