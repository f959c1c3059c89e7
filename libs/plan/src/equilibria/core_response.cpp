// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "equilibria/core_response.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "equilibria/changed_robot.hpp"
#include "holdfast/solver/largest.hpp"
#include "holdfast/verdict/assessment.hpp"

namespace holdfast::plan {
namespace {

using base::at;
using base::Vec6;
using mechanics::ContactLaw;
using solver::FacetState;

/// More feet in other states than the core's make the dense system slower than a check.
constexpr std::size_t kChangedMax = 24;

/// Columns of modules take no more than this.
constexpr std::size_t kColumnBytesMax = std::size_t{256} << 20U;

/// What may fill in, per module: as for the exact law of contact.
constexpr std::size_t kCoreFillMax = 64;

/// The error that is left of a column, as a share of it; beyond it digits are missing.
constexpr double kColumnError = 1e-9;

/// The first three and the last three differ in unit; each is compared with its own.
bool is_close(const std::vector<Vec6<double>>& a, const std::vector<Vec6<double>>& b) {
  double size[2] = {0, 0};
  double change[2] = {0, 0};
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t k = 0; k < 6; ++k) {
      size[k / 3] = std::max(size[k / 3], std::abs(a[i][k]));
      change[k / 3] = std::max(change[k / 3], std::abs(a[i][k] - b[i][k]));
    }
  }
  return change[0] <= kColumnError * size[0] && change[1] <= kColumnError * size[1];
}

void add(std::vector<Vec6<double>>& sum, double factor, const std::vector<Vec6<double>>& more) {
  for (std::size_t i = 0; factor != 0 && i < sum.size(); ++i) {
    base::add_times(sum[i], factor, more[i]);
  }
}

}  // namespace

/// One robot, module by module beside the core.
class CoreResponse::Member {
 public:
  Member(const CoreResponse& core, const model::Robot& robot) : core_(core), robot_(robot) {}

  std::optional<solver::Equilibrium> solve() {
    if (!match_modules() || !match_facets() || !match_connections()) {
      return std::nullopt;
    }
    change_.links = links_;
    change_.new_modules = [this](std::span<const FacetState> own) {
      return std::make_shared<const NewModules>(core_, links_, beams_, new_loads_, own);
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

  /// Finds each module in the core; false if the robot does not contain it.
  bool match_modules() {
    const auto modules = robot_.modules();
    const auto core = core_.core_.modules();
    if (modules.size() < core.size() || modules.size() > core.size() + kNewMax) {
      return false;
    }
    std::size_t next = 0;
    for (std::size_t i = 0; i < modules.size(); ++i) {
      const Vec& load = robot_.loads()[i];
      scale_n_ += std::hypot(load[0], load[1], load[2]);
      if (next < core.size() && modules[i].cell == core[next].cell) {
        const Vec& before = core_.core_.loads()[next];
        if (load != before) {
          change_.loads.push_back({.module = next, .load = base::sum_of<double>(load, -1, before)});
        }
        places_.push_back({.is_new = false, .index = next++});
        continue;
      }
      if (modules[i].support == model::Support::kFixed) {
        return false;
      }
      places_.push_back({.is_new = true, .index = new_loads_.size()});
      new_loads_.push_back(load);
    }
    return next == core.size();
  }

  bool match_facets() {
    const auto core = core_.core_.facets();
    std::size_t next = 0;
    for (const model::Facet& facet : robot_.facets()) {
      const Place& module = places_[at(facet.module)];
      facets_.push_back({.is_new = module.is_new, .index = next});
      if (module.is_new) {
        facets_.back().index = core.size() + change_.facets.size();
        change_.facets.push_back({.module = module.index,
                                  .direction = facet.direction,
                                  .is_bonded = facet.is_bonded(),
                                  .state = {}});
      } else if (next == core.size() || at(core[next].module) != module.index ||
                 core[next++].direction != facet.direction) {
        return false;
      }
    }
    return next == core.size();
  }

  /// All that the core does not have must end at a new module.
  bool match_connections() {
    std::size_t shared_count = 0;
    for (const model::Connection& pair : robot_.connections()) {
      const Place& a = places_[at(pair.a)];
      const Place& b = places_[at(pair.b)];
      if (a.is_new && b.is_new) {
        beams_.push_back({.a = static_cast<std::int32_t>(a.index),
                          .b = static_cast<std::int32_t>(b.index),
                          .direction = pair.direction});
      } else if (b.is_new) {
        links_.push_back({.host = a.index, .direction = pair.direction, .to = b.index});
      } else if (a.is_new) {
        links_.push_back(
            {.host = b.index, .direction = base::opposite(pair.direction), .to = a.index});
      }
      shared_count += a.is_new || b.is_new ? 0 : 1;
    }
    return shared_count == core_.core_.connections().size();
  }

  solver::Equilibrium equilibrium(const Changed& settled) const {
    Answer sum = core_.own_;
    for (const PointLoad& load : settled.loads) {
      const Column& column = *core_.column(load.module);
      for (std::size_t k = 0; k < 6; ++k) {
        add(sum.refined, load.load[k], column[k].refined);
        add(sum.rough, load.load[k], column[k].rough);
      }
    }
    Vecs hosts;
    for (const Link& link : links_) {
      hosts.push_back(sum.refined[link.host]);
    }
    const Vecs moved = settled.new_modules->displacements(hosts);
    solver::Equilibrium found;
    found.outcome = solver::Outcome::kSettled;
    found.law = ContactLaw::kRegularised;
    found.gamma = core_.system_->ground().gamma;
    found.displacement.reserve(places_.size());
    found.alternative.reserve(places_.size());
    for (const Place& module : places_) {
      found.displacement.push_back((module.is_new ? moved : sum.refined)[module.index]);
      found.alternative.push_back((module.is_new ? moved : sum.rough)[module.index]);
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

  const CoreResponse& core_;
  const model::Robot& robot_;
  std::vector<Place> places_;  ///< By module.
  std::vector<Place> facets_;  ///< By facet: in the states of Changed.
  std::vector<Link> links_;
  std::vector<model::Connection> beams_;  ///< Between new modules.
  Vecs new_loads_;
  Change change_;
  double scale_n_ = 0;  ///< All loads together.
};

std::unique_ptr<CoreResponse> CoreResponse::make(model::Robot core,
                                                 const solver::EquilibriumOptions& options) {
  std::unique_ptr<CoreResponse> response(new CoreResponse(std::move(core)));
  return response->prepare(options) ? std::move(response) : nullptr;
}

CoreResponse::CoreResponse(model::Robot core) : core_(std::move(core)) {}

bool CoreResponse::prepare(const solver::EquilibriumOptions& options) {
  if (options.is_bonded) {
    return false;
  }
  solver::EquilibriumOptions direct = options;
  direct.method = solver::Method::kDirect;
  direct.fill_max = kCoreFillMax;
  const solver::ContactOptions contact = {.law = ContactLaw::kRegularised,
                                          .gamma = core_.material().contact_gamma};
  const solver::Equilibrium settled = solver::EquilibriumSolver(core_, direct).solve(contact);
  if (settled.outcome != solver::Outcome::kSettled) {
    return false;
  }
  system_ = solver::make_linear_system(core_, direct);
  if (!system_) {
    return false;
  }
  system_->set_law(contact);
  for (std::size_t i = 0; i < settled.contact.size(); ++i) {
    system_->set_facet(i, settled.contact[i], true);
  }
  auto own = answers({core_.loads()});
  if (!own) {
    return false;
  }
  own_ = std::move(own->front());
  return true;
}

std::optional<std::vector<CoreResponse::Answer>> CoreResponse::answers(
    const std::vector<model::Loads>& loads) const {
  auto rough = system_->solve_each(loads, 0);
  if (!rough) {
    return std::nullopt;
  }
  std::vector<model::Loads> residuals;
  for (std::size_t i = 0; i < loads.size(); ++i) {
    residuals.emplace_back(residual(loads[i], (*rough)[i]));
  }
  const auto corrections = system_->solve_each(residuals, 0);
  if (!corrections) {
    return std::nullopt;
  }
  std::vector<Answer> answers;
  for (std::size_t i = 0; i < loads.size(); ++i) {
    Answer answer{.refined = (*rough)[i], .rough = std::move((*rough)[i])};
    for (std::size_t k = 0; k < answer.refined.size(); ++k) {
      base::add_to(answer.refined[k], (*corrections)[i][k]);
    }
    if (!(solver::largest(answer.refined) < 1e300) || !is_close(answer.refined, answer.rough)) {
      return std::nullopt;
    }
    answers.push_back(std::move(answer));
  }
  return answers;
}

/// What of a load the displacements do not balance.
CoreResponse::Vecs CoreResponse::residual(const model::Loads& load,
                                          const Vecs& displacement) const {
  Vecs rest(displacement.size());
  for (std::size_t i = 0; i < rest.size(); ++i) {
    rest[i] = load[i];
  }
  const auto subtract = [&](std::size_t module, const Vec& force) {
    base::add_times(rest[module], -1, force);
  };
  for (const model::Connection& pair : core_.connections()) {
    const Vec& a = displacement[at(pair.a)];
    const Vec& b = displacement[at(pair.b)];
    subtract(at(pair.a), system_->beam().end_force(pair.direction, a, b));
    subtract(at(pair.b), system_->beam().end_force(base::opposite(pair.direction), b, a));
  }
  for (const FacetState& facet : system_->facets()) {
    subtract(facet.module, system_->law().force(facet, displacement[facet.module]));
  }
  return rest;
}

/// None if digits are missing.
const CoreResponse::Column* CoreResponse::column(std::size_t module) const {
  std::unique_ptr<const Column>& known = columns_[module];
  if (known) {
    return known.get();
  }
  std::vector<model::Loads> loads;
  for (int k = 0; k < 6; ++k) {
    Vecs unit(core_.modules().size(), Vec{});
    unit[module] = base::unit<double>(k);
    loads.emplace_back(std::move(unit));
  }
  auto six = answers(loads);
  if (!six) {
    return nullptr;
  }
  auto column = std::make_unique<Column>();
  std::ranges::move(*six, column->begin());
  known = std::move(column);
  ++column_count_;
  return known.get();
}

bool CoreResponse::knows(std::span<const std::size_t> modules) const {
  return modules.size() <= kChangedMax &&
         std::ranges::all_of(modules, [&](std::size_t each) { return column(each) != nullptr; });
}

Vec6<double> CoreResponse::answer(std::size_t module, const PointLoad& load) const {
  const Column& six = *column(load.module);
  Vec u{};
  for (std::size_t k = 0; k < 6; ++k) {
    base::add_times(u, load.load[k], six[k].refined[module]);
  }
  return u;
}

std::optional<solver::Equilibrium> CoreResponse::solve(const model::Robot& robot) {
  const std::size_t column_bytes = 12 * sizeof(Vec) * core_.modules().size();
  if (column_count_ == 0 || column_count_ * column_bytes > kColumnBytesMax) {
    columns_.clear();
    columns_.resize(core_.modules().size());
    column_count_ = 0;
  }
  return Member(*this, robot).solve();
}

}  // namespace holdfast::plan
