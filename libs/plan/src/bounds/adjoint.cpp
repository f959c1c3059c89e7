// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "bounds/adjoint.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "block_product.hpp"
#include "equilibria/carried_force.hpp"
#include "equilibria/stuck_core.hpp"
#include "holdfast/base/lattice.hpp"
#include "holdfast/host/team.hpp"
#include "holdfast/mechanics/ground_contact.hpp"
#include "holdfast/model/material.hpp"

namespace holdfast::plan {
namespace {

using base::at;
using base::Direction;
using base::Vec6;

/// The tolerance of z, as a share of its own energy norm: what it costs is that share of what other
/// displacements are off, and of how far the core moves. With 1e-3 the facet nearest to tilting in
/// growth of 10,000 leaves 38 of the last 785 states without a bound; 1e-5 is no better.
constexpr double kAdjointTolerance = 1e-4;

/// Adds z . u by component of a displacement, so that no sum waits for another.
void add_products(const ThreeVectors& z, const Vec6<double>& u, ThreeVectors& sum) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 6; ++k) {
      sum[i][k] += z[i][k] * u[k];
    }
  }
}

/// z . rest of the first modules that have a z.
ThreeVectors products(std::span<const Element> modules, const std::vector<ThreeVectors>& z,
                      const std::vector<Vec6<double>>& rest) {
  ThreeVectors sum{};
  for (std::size_t place = 0; place < modules.size(); ++place) {
    add_products(z[place], rest[at(modules[place])], sum);
  }
  return sum;
}

/// The adjoint of a facet, by index in the target; null if it cannot be solved.
std::shared_ptr<Adjoint> find_adjoint(StuckCore& core, const model::Robot& target,
                                      std::shared_ptr<const std::vector<Element>> elements,
                                      std::size_t facet) {
  const std::size_t count = elements->size();
  Adjoint::Core adjoint{.facet = facet,
                        .load = facet_loads(target, core.system().beam(), target.facets()[facet]),
                        .modules = std::move(elements),
                        .z = std::vector<ThreeVectors>(count)};
  const auto place = static_cast<std::size_t>(
      std::ranges::lower_bound(*adjoint.modules, target.facets()[facet].module) -
      adjoint.modules->begin());
  for (std::size_t i = 0; i < 3; ++i) {
    std::vector<Vec6<double>> loads(count);
    loads[place] = adjoint.load[i];
    const auto answer = core.answer(loads, kAdjointTolerance);
    if (!answer) {
      return nullptr;
    }
    for (std::size_t k = 0; k < count; ++k) {
      adjoint.z[k][i] = answer->displacement[k];
    }
    adjoint.error[i] = answer->error;
  }
  return std::make_shared<Adjoint>(target, std::move(adjoint));
}

}  // namespace

ThreeVectors facet_loads(const model::Robot& target, const model::LatticeBeam<double>& beam,
                         const model::Facet& facet) {
  const auto law = solver::facet_law(target, beam, {.gamma = 0}).ground();
  ThreeVectors loads{};
  for (int k = 0; k < 6; ++k) {
    const auto force =
        mechanics::trial_force(law, beam.to_local(facet.direction, base::unit<double>(k)));
    for (std::size_t i = 0; i < 3; ++i) {
      loads[i][at(k)] = force[2 + i];
    }
  }
  return loads;
}

void Gram::add(const ThreeVectors& forces, const Vec6<double>& stiffness) {
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t c = 0; c < 6; ++c) {
        products_[3 * i + k] += forces[i][c] * forces[k][c] / stiffness[c];
      }
    }
  }
}

double Gram::norm(const Triple& factors) const {
  double sum = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      sum += factors[i] * products_[3 * i + k] * factors[k];
    }
  }
  return std::sqrt(std::max(0.0, sum));
}

Adjoint::Adjoint(const model::Robot& target, Core core)
    : target_(&target),
      beam_(model::beam_section(target.material()), target.lattice()),
      stiffness_(middle_stiffness(beam_)),
      core_(std::move(core)),
      local_(target) {
  shrink_to_core();
}

void Adjoint::shrink_to_core() {
  local_.assign(*core_.modules);
  place_.assign(target_->modules().size(), kAbsent);
  for (std::size_t i = 0; i < core_.modules->size(); ++i) {
    place_[at((*core_.modules)[i])] = static_cast<std::int32_t>(i);
  }
  grown_.clear();
  grown_modules_.clear();
  gram_.assign(1, {});
  lift_.assign(1, {});
  settled_count_ = 0;
  pulls_.clear();
  pull_count_.assign(1, 0);
}

bool Adjoint::is_beside(std::size_t module) const {
  return std::ranges::any_of(target_->connected()[module], [&](std::int32_t other) {
    return other != model::Robot::kNoNeighbour && is_known(at(other));
  });
}

bool Adjoint::grow_to(const std::vector<Element>& elements) {
  const auto is_there = [&](Element element) { return is_known(at(element)); };
  const auto known_count = [&] {
    return static_cast<std::size_t>(std::ranges::count_if(elements, is_there));
  };
  if (known_count() < core_.modules->size() + grown_.size()) {
    shrink_to_core();
    if (known_count() < core_.modules->size()) {
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
  settled_count_ = grown_.size();
  pulls_.clear();
  pull_count_.assign(1, 0);
  return missing.empty();
}

std::optional<std::size_t> Adjoint::count_in(const std::vector<Element>& elements) const {
  const auto end = static_cast<std::int32_t>(elements.size());
  const bool is_on_way =
      elements.size() >= core_.z.size() && std::ranges::all_of(elements, [&](Element element) {
        return is_known(at(element)) && place_[at(element)] < end;
      });
  if (!is_on_way || elements.size() < core_.z.size() + settled_count_) {
    return std::nullopt;
  }
  return elements.size() - core_.z.size();
}

bool Adjoint::are_next(std::size_t count, std::span<const std::size_t> modules) const {
  return count + modules.size() <= grown_modules_.size() &&
         std::equal(modules.begin(), modules.end(),
                    grown_modules_.begin() + static_cast<std::ptrdiff_t>(count),
                    [](std::size_t a, Element b) { return a == at(b); });
}

/// Calls each(direction, other) for the beams of a module to those that came before it.
template <class Each>
void Adjoint::for_each_beam(std::size_t module, const Each& each) const {
  for (const Direction direction : base::directions(target_->lattice())) {
    const std::int32_t other = target_->connected()[module][at(base::index(direction))];
    if (other != model::Robot::kNoNeighbour && is_known(at(other)) &&
        place_[at(other)] < place_[module]) {
      each(direction, at(other));
    }
  }
}

template <class Each>
void Adjoint::for_each_facet(std::size_t module, const Each& each) const {
  const auto index = static_cast<std::int32_t>(module);
  const auto facets = target_->facets();
  auto own = std::ranges::lower_bound(facets, index, {}, &model::Facet::module);
  for (; own != facets.end() && own->module == index; ++own) {
    each(own->direction);
  }
}

void Adjoint::grow(std::size_t module) {
  local_.insert(module);
  place_[module] = static_cast<std::int32_t>(core_.z.size() + grown_.size());
  ThreeVectors own{};
  const bool is_fixed = target_->modules()[module].support == model::Support::kFixed;
  for (std::size_t i = 0; i < 3 && !is_fixed; ++i) {
    Vec pull{};
    for_each_beam(module, [&](Direction direction, std::size_t other) {
      const Vec force = beam_.end_force(direction, {}, z(i, other));
      base::add_times(pull, -1, force);
    });
    own[i] = block_product(local_.stiffness(module).inverse, pull);
  }
  grown_.push_back(own);
  grown_modules_.push_back(static_cast<Element>(module));
  gram_.push_back(gram_.back());
  add_gaps(module, gram_.back());
  Triple lift = lift_.back();
  for (std::size_t i = 0; i < 3; ++i) {
    lift[i] += base::dot(own[i], target_->loads()[module]);
  }
  lift_.push_back(lift);
  find_pulls(module);
  pull_count_.push_back(pulls_.size());
}

void Adjoint::shrink() {
  const std::size_t module = at(grown_modules_.back());
  local_.erase(module);
  place_[module] = kAbsent;
  grown_.pop_back();
  grown_modules_.pop_back();
  gram_.pop_back();
  lift_.pop_back();
  pull_count_.pop_back();
  pulls_.resize(pull_count_.back());
}

/// Finds the pulls of a module that has grown. It is in balance itself; one that is connected to a
/// single other one moves with that and pulls at nothing.
void Adjoint::find_pulls(std::size_t module) {
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

/// Adds e in the beams and facets of a module that has grown.
void Adjoint::add_gaps(std::size_t module, Gram& gram) const {
  ThreeVectors forces;
  for_each_beam(module, [&](Direction direction, std::size_t other) {
    for (std::size_t i = 0; i < 3; ++i) {
      forces[i] = beam_.middle_force(direction, z(i, module), z(i, other));
    }
    gram.add(forces, stiffness_);
  });
  for_each_facet(module, [&](Direction direction) {
    for (std::size_t i = 0; i < 3; ++i) {
      forces[i] = force_in_middle(beam_, direction, local_.facet_force(direction, z(i, module)),
                                  target_->material().pitch_mm);
    }
    gram.add(forces, stiffness_);
  });
}

Triple Adjoint::force(const std::vector<Vec>& u, const std::vector<Vec>& rest,
                      std::size_t count) const {
  const ThreeVectors core = products(*core_.modules, core_.z, rest);
  const ThreeVectors grown = products(std::span(grown_modules_).first(count), grown_, rest);
  const std::size_t module = at(target_->facets()[facet()].module);
  Triple force{};
  for (std::size_t i = 0; i < 3; ++i) {
    force[i] = base::dot(core_.load[i], u[module]) +
               std::accumulate(core[i].begin(), core[i].end(), 0.0) +
               std::accumulate(grown[i].begin(), grown[i].end(), 0.0);
  }
  return force;
}

std::span<const Adjoint::Pull> Adjoint::pulls(std::size_t first, std::size_t end) const {
  const std::size_t begin = pull_count_[first - settled_count_];
  return std::span(pulls_).subspan(begin, pull_count_[end - settled_count_] - begin);
}

Triple Adjoint::share(const std::vector<Vec>& u, std::size_t first, std::size_t end) const {
  ThreeVectors sum{};
  for (const Pull& pull : pulls(first, end)) {
    add_products(pull.force, u[pull.module], sum);
  }
  Triple share{};
  for (std::size_t i = 0; i < 3; ++i) {
    share[i] = lift_[end][i] - lift_[first][i] - std::accumulate(sum[i].begin(), sum[i].end(), 0.0);
  }
  return share;
}

double Adjoint::error(const Triple& factors, std::size_t count) const {
  double own = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    own += std::abs(factors[i]) * core_.error[i];
  }
  return std::hypot(gram_[count].norm(factors), own);
}

Adjoints find_adjoints(const model::RobotSpec& spec, const model::Robot& target,
                       const ElementSet& core, const std::vector<std::size_t>& facets,
                       int thread_count, const std::function<bool()>& is_late) {
  const auto shared = std::make_shared<const std::vector<Element>>(core.elements());
  Adjoints adjoints(facets.size());
  host::Team team(thread_count);
  const std::size_t group_count = std::min(at(team.thread_count()), facets.size());
  team.each(group_count, [&](std::size_t group) {
    const auto stuck = StuckCore::make(spec, core, solver::Precision::kSingle);
    for (std::size_t i = group; stuck && i < facets.size() && !is_late(); i += group_count) {
      adjoints[i] = find_adjoint(*stuck, target, shared, facets[i]);
    }
  });
  std::erase(adjoints, nullptr);
  return adjoints;
}

}  // namespace holdfast::plan
