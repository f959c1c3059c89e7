// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "grown_adjoint.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <span>

#include "carried_force.hpp"
#include "holdfast/base/lattice.hpp"
#include "holdfast/model/material.hpp"

namespace holdfast::plan {
namespace {

using base::at;
using base::Direction;
using base::Vec6;

/// z . rest by component of a displacement, so that no sum waits for another, of the first modules
/// that have a z.
std::array<Vec6<double>, 3> products(std::span<const Element> modules,
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
  return missing.empty();
}

std::optional<std::size_t> GrownAdjoint::count_in(const std::vector<Element>& elements) const {
  const auto end = static_cast<std::int32_t>(elements.size());
  const bool is_on_way =
      elements.size() >= core_->z.size() && std::ranges::all_of(elements, [&](Element element) {
        return is_known(at(element)) && place_[at(element)] < end;
      });
  return is_on_way ? std::optional(elements.size() - core_->z.size()) : std::nullopt;
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
    own[i] = base::multiply(local_.stiffness(module).inverse, pull);
  }
  grown_.push_back(own);
  grown_modules_.push_back(static_cast<Element>(module));
  std::array<double, 9> gram = products_of_gaps(module);
  for (std::size_t i = 0; i < gram.size(); ++i) {
    gram[i] += gram_.back()[i];
  }
  gram_.push_back(gram);
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

GrownAdjoint::Triple GrownAdjoint::work(const std::vector<Vec>& rest, std::size_t count) const {
  const std::array<Vec, 3> core = products(*core_->core, core_->z, rest);
  const std::array<Vec, 3> grown = products(std::span(grown_modules_).first(count), grown_, rest);
  Triple work{};
  for (std::size_t i = 0; i < 3; ++i) {
    work[i] = std::accumulate(core[i].begin(), core[i].end(), 0.0) +
              std::accumulate(grown[i].begin(), grown[i].end(), 0.0);
  }
  return work;
}

GrownAdjoint::Triple GrownAdjoint::work_of_next(std::size_t count,
                                                const std::vector<Vec>& u) const {
  const std::size_t module = at(grown_modules_[count]);
  Triple work{};
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec& own = z(i, module);
    work[i] = base::dot(own, target_->loads()[module]);
    for_each_beam(module, [&](Direction direction, std::size_t other) {
      const Vec e = beam_.middle_force(direction, own, z(i, other));
      const Vec gap = beam_.middle_force(direction, u[module], u[other]);
      for (std::size_t c = 0; c < 6; ++c) {
        work[i] -= e[c] * gap[c] / stiffness_[c];
      }
    });
    for_each_facet(module, [&](Direction direction) {
      work[i] -= base::dot(own, local_.facet_force(direction, u[module]));
    });
  }
  return work;
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

}  // namespace holdfast::plan
