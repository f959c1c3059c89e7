// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "grown_adjoint.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>

#include "block_product.hpp"
#include "carried_force.hpp"
#include "holdfast/base/lattice.hpp"
#include "holdfast/model/material.hpp"

namespace holdfast::plan {
namespace {

using base::at;
using base::Direction;
using base::Vec6;

/// A module whose e has no more than this share of the square of the error of the core's z does not
/// pay to be looked at each time: of those that have grown in growth of 10,000 modules four in
/// five.
constexpr double kSmall = 0.01;

/// Adds z . u by component of a displacement, so that no sum waits for another.
void add_products(const std::array<Vec6<double>, 3>& z, const Vec6<double>& u,
                  std::array<Vec6<double>, 3>& sum) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 6; ++k) {
      sum[i][k] += z[i][k] * u[k];
    }
  }
}

/// z . rest of the first modules that have a z.
std::array<Vec6<double>, 3> products(std::span<const Element> modules,
                                     const std::vector<std::array<Vec6<double>, 3>>& z,
                                     const std::vector<Vec6<double>>& rest) {
  std::array<Vec6<double>, 3> sum{};
  for (std::size_t place = 0; place < modules.size(); ++place) {
    add_products(z[place], rest[at(modules[place])], sum);
  }
  return sum;
}

}  // namespace

GrownAdjoint::GrownAdjoint(const model::Robot& target, std::shared_ptr<const FacetAdjoint> core)
    : target_(&target),
      beam_(model::beam_section(target.material()), target.lattice()),
      stiffness_(middle_stiffness(beam_)),
      core_(std::move(core)),
      local_(target) {
  shrink_to_core();
}

void GrownAdjoint::shrink_to_core() {
  local_.assign(*core_->core);
  place_.assign(target_->modules().size(), kAbsent);
  for (std::size_t i = 0; i < core_->core->size(); ++i) {
    place_[at((*core_->core)[i])] = static_cast<std::int32_t>(i);
  }
  grown_.clear();
  grown_modules_.clear();
  gram_.assign(1, {});
  lift_.assign(1, {});
  settled_count_ = 0;
  settled_.clear();
  left_out_ = {};
  settled_place_.assign(target_->modules().size(), kAbsent);
  pulls_.clear();
  pull_count_.assign(1, 0);
}

bool GrownAdjoint::is_beside(std::size_t module) const {
  return std::ranges::any_of(target_->connected()[module], [&](std::int32_t other) {
    return other != model::Robot::kNoNeighbour && is_known(at(other));
  });
}

bool GrownAdjoint::grow_to(const std::vector<Element>& elements) {
  const auto is_there = [&](Element element) { return is_known(at(element)); };
  const auto known_count = [&] {
    return static_cast<std::size_t>(std::ranges::count_if(elements, is_there));
  };
  if (known_count() < core_->core->size() + grown_.size()) {
    shrink_to_core();
    if (known_count() < core_->core->size()) {
      return false;
    }
  }
  std::vector<Element> missing = elements;
  std::erase_if(missing, is_there);
  for (bool has_grown = true; has_grown;) {
    has_grown = std::erase_if(missing, [&](Element element) {
                  const bool can_grow = is_beside(at(element));
                  if (can_grow) {
                    grow(at(element));
                  }
                  return can_grow;
                }) > 0;
  }
  settle();
  return missing.empty();
}

/// What has grown so far is asked for as a whole only from now on.
void GrownAdjoint::settle() {
  for (std::size_t count = settled_count_; count < grown_.size(); ++count) {
    if (!leave_out(count)) {
      std::ranges::for_each(pulls(count, count + 1), [&](const Pull& pull) { add_up(pull); });
    }
  }
  settled_count_ = grown_.size();
  pulls_.clear();
  pull_count_.assign(1, 0);
}

/// Of the module that comes after so many the pulls, if its e is so small that they are better
/// counted as an error. Returns whether it is.
bool GrownAdjoint::leave_out(std::size_t count) {
  Triple square{};
  bool is_small = true;
  for (std::size_t i = 0; i < 3; ++i) {
    const double sum = gram_[count + 1][4 * i];
    square[i] = sum - gram_[count][4 * i] + std::numeric_limits<double>::epsilon() * sum;
    is_small = is_small && square[i] <= kSmall * core_->error[i] * core_->error[i];
  }
  for (std::size_t i = 0; is_small && i < 3; ++i) {
    left_out_[i] += square[i];
  }
  return is_small;
}

void GrownAdjoint::add_up(const Pull& pull) {
  std::int32_t& place = settled_place_[pull.module];
  if (place == kAbsent) {
    place = static_cast<std::int32_t>(settled_.size());
    settled_.push_back({.module = pull.module});
  }
  for (std::size_t i = 0; i < 3; ++i) {
    base::add_to(settled_[at(place)].force[i], pull.force[i]);
  }
}

std::optional<std::size_t> GrownAdjoint::count_in(const std::vector<Element>& elements) const {
  const auto end = static_cast<std::int32_t>(elements.size());
  const bool is_on_way =
      elements.size() >= core_->z.size() && std::ranges::all_of(elements, [&](Element element) {
        return is_known(at(element)) && place_[at(element)] < end;
      });
  if (!is_on_way || elements.size() < core_->z.size() + settled_count_) {
    return std::nullopt;
  }
  return elements.size() - core_->z.size();
}

/// Those to modules that came before it.
template <class Each>
void GrownAdjoint::for_each_beam(std::size_t module, const Each& each) const {
  for (const Direction direction : base::directions(target_->lattice())) {
    const std::int32_t other = target_->connected()[module][at(base::index(direction))];
    if (other != model::Robot::kNoNeighbour && is_known(at(other)) &&
        place_[at(other)] < place_[module]) {
      each(direction, at(other));
    }
  }
}

template <class Each>
void GrownAdjoint::for_each_facet(std::size_t module, const Each& each) const {
  const auto index = static_cast<std::int32_t>(module);
  const auto facets = target_->facets();
  auto own = std::ranges::lower_bound(facets, index, {}, &model::Facet::module);
  for (; own != facets.end() && own->module == index; ++own) {
    each(own->direction);
  }
}

void GrownAdjoint::grow(std::size_t module) {
  local_.insert(module);
  place_[module] = static_cast<std::int32_t>(core_->z.size() + grown_.size());
  std::array<Vec, 3> own{};
  const bool is_fixed = target_->modules()[module].support == model::Support::kFixed;
  for (std::size_t i = 0; i < 3 && !is_fixed; ++i) {
    Vec pull{};
    for_each_beam(module, [&](Direction direction, std::size_t other) {
      const Vec force = beam_.end_force(direction, {}, z(i, other));
      for (std::size_t k = 0; k < 6; ++k) {
        pull[k] -= force[k];
      }
    });
    own[i] = block_product(local_.stiffness(module).inverse, pull);
  }
  grown_.push_back(own);
  grown_modules_.push_back(static_cast<Element>(module));
  std::array<double, 9> gram = products_of_gaps(module);
  for (std::size_t i = 0; i < gram.size(); ++i) {
    gram[i] += gram_.back()[i];
  }
  gram_.push_back(gram);
  Triple lift = lift_.back();
  for (std::size_t i = 0; i < 3; ++i) {
    lift[i] += base::dot(own[i], target_->loads()[module]);
  }
  lift_.push_back(lift);
  find_pulls(module);
  pull_count_.push_back(pulls_.size());
}

/// Those of a module that has grown. It is in balance itself; one that hangs on another by a single
/// beam moves with that.
void GrownAdjoint::find_pulls(std::size_t module) {
  const std::size_t first = pulls_.size();
  for_each_beam(module, [&](Direction direction, std::size_t other) {
    Pull& pull = pulls_.emplace_back(Pull{.module = other});
    for (std::size_t i = 0; i < 3; ++i) {
      pull.force[i] = beam_.end_force(base::opposite(direction), z(i, other), z(i, module));
    }
  });
  bool has_facet = false;
  for_each_facet(module, [&](Direction /*direction*/) { has_facet = true; });
  const bool is_fixed = target_->modules()[module].support == model::Support::kFixed;
  if (pulls_.size() == first + 1 && !has_facet && !is_fixed) {
    pulls_.pop_back();
  }
}

/// <e_i, e_k> in the beams and facets of a module that has grown.
std::array<double, 9> GrownAdjoint::products_of_gaps(std::size_t module) const {
  std::array<double, 9> products{};
  const auto add = [&](const std::array<Vec, 3>& forces) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t c = 0; c < 6; ++c) {
          products[3 * i + k] += forces[i][c] * forces[k][c] / stiffness_[c];
        }
      }
    }
  };
  std::array<Vec, 3> forces;
  for_each_beam(module, [&](Direction direction, std::size_t other) {
    for (std::size_t i = 0; i < 3; ++i) {
      forces[i] = beam_.middle_force(direction, z(i, module), z(i, other));
    }
    add(forces);
  });
  for_each_facet(module, [&](Direction direction) {
    for (std::size_t i = 0; i < 3; ++i) {
      forces[i] = force_in_middle(beam_, direction, local_.facet_force(direction, z(i, module)),
                                  target_->material().pitch_mm);
    }
    add(forces);
  });
  return products;
}

GrownAdjoint::Triple GrownAdjoint::force(const std::vector<Vec>& u, const std::vector<Vec>& rest,
                                         std::size_t count) const {
  const std::array<Vec, 3> core = products(*core_->core, core_->z, rest);
  const std::array<Vec, 3> grown = products(std::span(grown_modules_).first(count), grown_, rest);
  const std::size_t module = at(target_->facets()[facet()].module);
  Triple force{};
  for (std::size_t i = 0; i < 3; ++i) {
    force[i] = base::dot(core_->load[i], u[module]) +
               std::accumulate(core[i].begin(), core[i].end(), 0.0) +
               std::accumulate(grown[i].begin(), grown[i].end(), 0.0);
  }
  return force;
}

std::span<const GrownAdjoint::Pull> GrownAdjoint::pulls(std::size_t first, std::size_t end) const {
  const std::size_t begin = pull_count_[first - settled_count_];
  return std::span(pulls_).subspan(begin, pull_count_[end - settled_count_] - begin);
}

GrownAdjoint::Triple GrownAdjoint::share(const std::vector<Vec>& u, std::size_t first,
                                         std::size_t end) const {
  std::array<Vec, 3> sum{};
  for (const Pull& pull : pulls(first, end)) {
    add_products(pull.force, u[pull.module], sum);
  }
  Triple share{};
  for (std::size_t i = 0; i < 3; ++i) {
    share[i] = lift_[end][i] - lift_[first][i] - std::accumulate(sum[i].begin(), sum[i].end(), 0.0);
  }
  return share;
}

GrownAdjoint::Triple GrownAdjoint::share_of_moved(const std::vector<Vec>& u,
                                                  const std::vector<Vec>& still,
                                                  std::size_t count) const {
  std::array<Vec, 3> sum{};
  const auto add = [&](const Pull& pull) {
    Vec moved = u[pull.module];
    base::add_times(moved, -1, still[pull.module]);
    add_products(pull.force, moved, sum);
  };
  std::ranges::for_each(settled_, add);
  std::ranges::for_each(pulls(settled_count_, count), add);
  Triple share{};
  for (std::size_t i = 0; i < 3; ++i) {
    share[i] = -std::accumulate(sum[i].begin(), sum[i].end(), 0.0);
  }
  return share;
}

double GrownAdjoint::error(const Triple& factors, std::size_t count) const {
  const std::array<double, 9>& gram = gram_[count];
  double sum = 0;
  double own = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    own += std::abs(factors[i]) * core_->error[i];
    for (std::size_t k = 0; k < 3; ++k) {
      sum += factors[i] * gram[3 * i + k] * factors[k];
    }
  }
  return std::sqrt(std::max(0.0, sum) + own * own);
}

double GrownAdjoint::error_of_moved(const Triple& factors) const {
  double error = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    error += std::abs(factors[i]) * std::hypot(core_->error[i], std::sqrt(left_out_[i]));
  }
  return error;
}

}  // namespace holdfast::plan
