// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "equilibria/core_response.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "equilibria/changed_robot.hpp"

namespace holdfast::plan {
namespace {

using base::at;
using mechanics::ContactLaw;
using solver::FacetState;

/// More feet in other states than the core's make the dense system slower than a check.
constexpr std::size_t kChangedMax = 24;

/// No more beams or facets than a module of any lattice has may be lost.
constexpr std::size_t kLostMax = 14;

/// Columns of modules take no more than this.
constexpr std::size_t kColumnBytesMax = std::size_t{256} << 20U;

/// What may fill in, per module: as for the exact law of contact.
constexpr std::size_t kCoreFillMax = 64;

}  // namespace

/// One robot, module by module beside the core.
class CoreResponse::Member {
 public:
  using Vec = base::Vec6<double>;
  using Vecs = std::vector<Vec>;

  /// Keeps references.
  Member(const CoreResponse& response, SolvedCore& core, const model::Robot& robot)
      : response_(response), core_(core), robot_(robot) {}

  std::optional<solver::Equilibrium> solve() {
    if (!match_modules() || !match_facets() || !match_connections()) {
      return std::nullopt;
    }
    change_.find_answers = [this](std::span<const std::size_t> modules) {
      return modules.size() <= kChangedMax && core_.find_columns(modules, kColumnBytesMax);
    };
    const ChangedRobot changed(core_, change_, scale_n_);
    const auto settled = changed.settle();
    if (!settled || changed.may_have_others(*settled)) {
      return std::nullopt;
    }
    return equilibrium(*settled);
  }

 private:
  /// Where a module or a facet is, among the core's or the new ones.
  struct Place {
    bool is_new = false;
    std::size_t index = 0;
  };

  /// The core's module at `next` may be the one that is lost: its load goes.
  bool lose_module(std::size_t next) {
    const auto core = response_.robot_.modules();
    if (lost_module_ || next == core.size()) {
      return false;
    }
    lost_module_ = next;
    if (core[next].support != model::Support::kFixed) {
      change_.loads.push_back(
          {.module = next, .load = base::sum_of<double>({}, -1, response_.robot_.loads()[next])});
    }
    return true;
  }

  /// Finds each module in the core; false if the robot does not contain it, but for one.
  bool match_modules() {
    const auto modules = robot_.modules();
    const auto core = response_.robot_.modules();
    if (modules.size() + 1 < core.size() || modules.size() > core.size() + kNewMax) {
      return false;
    }
    std::size_t next = 0;
    const bool is_less = modules.size() < core.size();
    for (std::size_t i = 0; i < modules.size(); ++i) {
      const Vec& load = robot_.loads()[i];
      scale_n_ += std::hypot(load[0], load[1], load[2]);
      if (is_less && modules[i].cell != core[next].cell && !lose_module(next++)) {
        return false;
      }
      if (next < core.size() && modules[i].cell == core[next].cell) {
        if ((modules[i].support == model::Support::kFixed) !=
            (core[next].support == model::Support::kFixed)) {
          return false;
        }
        const Vec& before = response_.robot_.loads()[next];
        if (load != before) {
          change_.loads.push_back({.module = next, .load = base::sum_of<double>(load, -1, before)});
        }
        places_.push_back({.is_new = false, .index = next++});
        continue;
      }
      if (modules[i].support == model::Support::kFixed) {
        return false;
      }
      places_.push_back({.is_new = true, .index = change_.new_loads.size()});
      change_.new_loads.push_back(load);
    }
    return next == core.size() || (is_less && lose_module(next++) && next == core.size());
  }

  bool match_facets() {
    const auto core = response_.robot_.facets();
    std::size_t next = 0;
    for (const model::Facet& facet : robot_.facets()) {
      const Place& module = places_[at(facet.module)];
      while (!module.is_new && next < core.size() && !is_same(facet, core[next])) {
        change_.lost_facets.push_back(next++);
      }
      facets_.push_back({.is_new = module.is_new, .index = next});
      if (module.is_new) {
        facets_.back().index = core.size() + change_.facets.size();
        change_.facets.push_back({.module = module.index,
                                  .direction = facet.direction,
                                  .is_bonded = facet.is_bonded(),
                                  .state = {}});
      } else if (next++ == core.size()) {
        return false;
      }
    }
    for (; next < core.size(); ++next) {
      change_.lost_facets.push_back(next);
    }
    return change_.lost_facets.size() <= kLostMax;
  }

  /// Whether a facet of a module that the core has is this one of the core.
  bool is_same(const model::Facet& facet, const model::Facet& core) const {
    return places_[at(facet.module)].index == at(core.module) && core.direction == facet.direction;
  }

  /// All that the core does not have must end at a new module, and what the robot lacks is little.
  bool match_connections() {
    std::vector<model::Connection> shared;
    for (const model::Connection& pair : robot_.connections()) {
      const Place& a = places_[at(pair.a)];
      const Place& b = places_[at(pair.b)];
      if (a.is_new && b.is_new) {
        change_.beams.push_back({.a = static_cast<std::int32_t>(a.index),
                                 .b = static_cast<std::int32_t>(b.index),
                                 .direction = pair.direction});
      } else if (b.is_new) {
        change_.links.push_back({.host = a.index, .direction = pair.direction, .to = b.index});
      } else if (a.is_new) {
        change_.links.push_back(
            {.host = b.index, .direction = base::opposite(pair.direction), .to = a.index});
      }
      if (!a.is_new && !b.is_new) {
        shared.push_back({.a = static_cast<std::int32_t>(a.index),
                          .b = static_cast<std::int32_t>(b.index),
                          .direction = pair.direction});
      }
    }
    return match_lost(shared);
  }

  /// Finds the beams that are lost; false if the core does not have all others. The module that is
  /// lost hangs without weight on one of its beams: that changes nothing.
  bool match_lost(const std::vector<model::Connection>& shared) {
    std::size_t next = 0;
    bool hangs = !lost_module_ ||
                 response_.robot_.modules()[*lost_module_].support == model::Support::kFixed;
    for (const model::Connection& pair : response_.robot_.connections()) {
      if (next < shared.size() && pair.a == shared[next].a && pair.b == shared[next].b) {
        ++next;
        continue;
      }
      if (!hangs && (at(pair.a) == lost_module_ || at(pair.b) == lost_module_)) {
        hangs = true;
        continue;
      }
      change_.lost_beams.push_back(pair);
    }
    return next == shared.size() && change_.lost_beams.size() <= kLostMax;
  }

  solver::Equilibrium equilibrium(const Changed& settled) const {
    Vecs refined = response_.influence_->displacement();
    Vecs rough = response_.influence_->rough_displacement();
    for (const PointLoad& load : settled.loads) {
      for (std::size_t i = 0; i < refined.size(); ++i) {
        const Vec more = core_.answer(i, load);
        base::add_to(refined[i], more);
        base::add_to(rough[i], more);
      }
    }
    Vecs hosts;
    for (const Link& link : change_.links) {
      hosts.push_back(refined[link.host]);
    }
    const Vecs moved = settled.new_modules.displacements(hosts);
    solver::Equilibrium found;
    found.outcome = solver::Outcome::kSettled;
    found.law = ContactLaw::kRegularised;
    found.gamma = core_.law().ground().gamma;
    found.displacement.reserve(places_.size());
    found.alternative.reserve(places_.size());
    for (const Place& module : places_) {
      found.displacement.push_back((module.is_new ? moved : refined)[module.index]);
      found.alternative.push_back((module.is_new ? moved : rough)[module.index]);
    }
    for (std::size_t i = 0; i < facets_.size(); ++i) {
      FacetState facet = facets_[i].is_new
                             ? change_.facets[facets_[i].index - core_.facets().size()]
                             : core_.facets()[facets_[i].index];
      facet.state = settled.states[facets_[i].index];
      found.contact.push_back(facet.state);
      const Vec& u = found.displacement[at(robot_.facets()[i].module)];
      found.facet_force.push_back(base::sum_of<double>({}, -1, core_.law().force(facet, u)));
    }
    return found;
  }

  const CoreResponse& response_;
  SolvedCore& core_;
  const model::Robot& robot_;
  std::vector<Place> places_;  ///< By module.
  std::vector<Place> facets_;  ///< By facet: in the states of Changed.
  std::optional<std::size_t> lost_module_;
  Change change_;
  double scale_n_ = 0;  ///< All loads together.
};

std::unique_ptr<CoreResponse> CoreResponse::make(model::Robot core,
                                                 const solver::EquilibriumOptions& options) {
  if (options.is_bonded) {
    return nullptr;
  }
  std::unique_ptr<CoreResponse> response(new CoreResponse(std::move(core)));
  solver::EquilibriumOptions direct = options;
  direct.method = solver::Method::kDirect;
  direct.fill_max = kCoreFillMax;
  response->influence_ = solver::Influence::make(response->robot_, direct);
  if (!response->influence_ ||
      !(rounding_share(response->robot_, *response->influence_) <= kRoundingShareMax)) {
    return nullptr;
  }
  response->core_.emplace(*response->influence_);
  return response;
}

std::optional<solver::Equilibrium> CoreResponse::solve(const model::Robot& robot) {
  if (core_->column_bytes() > kColumnBytesMax / 2) {
    core_.emplace(*influence_);
  }
  return Member(*this, *core_, robot).solve();
}

}  // namespace holdfast::plan
