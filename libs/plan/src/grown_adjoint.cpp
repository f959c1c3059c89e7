// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "grown_adjoint.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "carried_force.hpp"
#include "holdfast/base/lattice.hpp"
#include "holdfast/model/material.hpp"

namespace holdfast::plan {
namespace {

using base::at;
using base::Direction;
using base::Vec6;

/// z . rest by component of a displacement, so that no sum waits for another.
std::array<Vec6<double>, 3> products(const std::vector<Element>& modules,
                                     const std::vector<std::array<Vec6<double>, 3>>& z,
                                     const std::vector<Vec6<double>>& rest) {
  std::array<Vec6<double>, 3> sum{};
  for (std::size_t place = 0; place < modules.size(); ++place) {
    const std::array<Vec6<double>, 3>& own = z[place];
    const Vec6<double>& load = rest[at(modules[place])];
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 6; ++k) {
        sum[i][k] += own[i][k] * load[k];
      }
    }
  }
  return sum;
}

}  // namespace

GrownAdjoint::GrownAdjoint(const model::Robot& target, std::shared_ptr<const FacetAdjoint> core)
    : target_(&target),
      beam_(model::beam_section(target.material()), target.lattice()),
      stiffness_(middle_stiffness(beam_)),
      core_(std::move(core)),
      local_(target),
      place_(target.modules().size()) {
  local_.assign(*core_->core);
  for (std::size_t i = 0; i < core_->core->size(); ++i) {
    place_[at((*core_->core)[i])] = static_cast<std::int32_t>(i);
  }
}

bool GrownAdjoint::is_beside(std::size_t module) const {
  return std::ranges::any_of(target_->connected()[module], [&](std::int32_t other) {
    return other != model::Robot::kNoNeighbour && local_.is_there(at(other));
  });
}

bool GrownAdjoint::grow_to(const std::vector<Element>& elements) {
  std::vector<std::size_t> missing;
  for (const Element element : elements) {
    if (!local_.is_there(at(element))) {
      missing.push_back(at(element));
    }
  }
  if (elements.size() - missing.size() < core_->core->size() + grown_.size()) {
    return false;
  }
  for (bool has_grown = true; has_grown;) {
    has_grown = std::erase_if(missing, [&](std::size_t module) {
                  const bool can_grow = is_beside(module);
                  if (can_grow) {
                    grow(module);
                  }
                  return can_grow;
                }) > 0;
  }
  return missing.empty();
}

template <class Each>
void GrownAdjoint::for_each_beam(std::size_t module, const Each& each) const {
  for (const Direction direction : base::directions(target_->lattice())) {
    const std::int32_t other = local_.neighbour(module, base::index(direction));
    if (other != model::Robot::kNoNeighbour) {
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
    own[i] = base::multiply(local_.stiffness(module).inverse, pull);
  }
  place_[module] = static_cast<std::int32_t>(core_->z.size() + grown_.size());
  grown_.push_back(own);
  grown_modules_.push_back(static_cast<Element>(module));
  weigh(module);
}

/// Adds the energies of e in the beams and facets of a module that has grown last.
void GrownAdjoint::weigh(std::size_t module) {
  const auto add = [&](const std::array<Vec, 3>& forces) {
    for (std::size_t i = 0; i < 3; ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        for (std::size_t c = 0; c < 6; ++c) {
          gram_[3 * i + k] += forces[i][c] * forces[k][c] / stiffness_[c];
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
}

void GrownAdjoint::set_rest(const std::vector<Vec>& rest) {
  const std::array<Vec, 3> core = products(*core_->core, core_->z, rest);
  const std::array<Vec, 3> grown = products(grown_modules_, grown_, rest);
  for (std::size_t i = 0; i < 3; ++i) {
    work_[i] = std::accumulate(core[i].begin(), core[i].end(), 0.0) +
               std::accumulate(grown[i].begin(), grown[i].end(), 0.0);
  }
}

void GrownAdjoint::add_rest(std::size_t module, const std::vector<Vec>& u) {
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec& own = z(i, module);
    work_[i] += base::dot(own, target_->loads()[module]);
    for_each_beam(module, [&](Direction direction, std::size_t other) {
      const Vec e = beam_.middle_force(direction, own, z(i, other));
      const Vec gap = beam_.middle_force(direction, u[module], u[other]);
      for (std::size_t c = 0; c < 6; ++c) {
        work_[i] -= e[c] * gap[c] / stiffness_[c];
      }
    });
    for_each_facet(module, [&](Direction direction) {
      work_[i] -= base::dot(own, local_.facet_force(direction, u[module]));
    });
  }
}

double GrownAdjoint::error(const Triple& factors) const {
  double sum = 0;
  double own = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    own += std::abs(factors[i]) * core_->error[i];
    for (std::size_t k = 0; k < 3; ++k) {
      sum += factors[i] * gram_[3 * i + k] * factors[k];
    }
  }
  return std::sqrt(std::max(0.0, sum) + own * own);
}

}  // namespace holdfast::plan
