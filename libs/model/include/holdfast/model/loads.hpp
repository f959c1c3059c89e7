// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "holdfast/base/algebra.hpp"
#include "holdfast/model/material.hpp"

/// Stores what acts on a robot from outside: the right-hand side of its equilibrium (Eq. 5).
namespace holdfast::model {

/// A force and a torque at the node of every module, [fx fy fz mx my mz] in N and N mm, global
/// frame. Weight is a load like any other. Where all modules carry the same, it is kept once.
class Loads {
 public:
  using Load = base::Vec6<double>;

  /// Puts the same load on every module.
  explicit Loads(const Load& common) : common_(common) {}

  /// Puts a load on each module by its index; of a robot with as many modules, at least one.
  explicit Loads(std::vector<Load> by_module) : by_module_(std::move(by_module)) {}

  const Load& operator[](std::size_t module) const {
    return by_module_.empty() ? common_ : by_module_[module];
  }

  /// Whether every module carries the same load, which is then that of any index.
  bool is_uniform() const { return by_module_.empty(); }

 private:
  Load common_{};
  std::vector<Load> by_module_;  ///< Empty if all are the same.
};

/// The loads of a robot of `material`: the weight of every module, straight down.
Loads weight_loads(const Material& material);

}  // namespace holdfast::model
