// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "core_response.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "contact_path.hpp"
#include "dense.hpp"
#include "holdfast/solver/largest.hpp"
#include "holdfast/solver/second_state.hpp"
#include "holdfast/verdict/assessment.hpp"

namespace holdfast::plan {
namespace {

using base::at;
using base::Mat6;
using base::Vec6;
using mechanics::ContactLaw;
using mechanics::ContactState;
using solver::FacetState;

/// More feet in other states than the core's make the dense system slower than a check.
constexpr std::size_t kChangedMax = 24;

/// Steps over contact states; most robots settle in one or two.
constexpr std::size_t kStepMax = 20;

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

void add_block(DenseSystem& system, std::size_t row, std::size_t column, const Mat6<double>& block,
               double sign) {
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < 6; ++k) {
      system.at(6 * row + static_cast<std::size_t>(i), 6 * column + static_cast<std::size_t>(k)) +=
          sign * block.at(i, k);
    }
  }
}

Mat6<double> product(const Mat6<double>& a, const Mat6<double>& b) {
  Mat6<double> c;
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < 6; ++k) {
      double sum = 0;
      for (int j = 0; j < 6; ++j) {
        sum += a.at(i, j) * b.at(j, k);
      }
      c.at(i, k) = sum;
    }
  }
  return c;
}

Vec6<double> product(const Mat6<double>& a, const Vec6<double>& x) {
  Vec6<double> y{};
  for (int i = 0; i < 6; ++i) {
    for (int k = 0; k < 6; ++k) {
      y[static_cast<std::size_t>(i)] += a.at(i, k) * x[static_cast<std::size_t>(k)];
    }
  }
  return y;
}

}  // namespace

/// One robot, module by module beside the core.
class CoreResponse::Grown {
 public:
  Grown(CoreResponse& whole, const model::Robot& robot) : whole_(whole), robot_(robot) {}

  std::optional<solver::Equilibrium> solve() {
    if (!match() || !add_loads() || !add_beams()) {
      return std::nullopt;
    }
    const auto settled =
        settled_states(ContactStates(robot_.facets().size(), mechanics::kStuck), kStepMax,
                       [&](const ContactStates& states) {
                         states_ = states;
                         return solve_for_states() ? std::optional(prescribed()) : std::nullopt;
                       });
    return settled && !is_doubtful() ? std::optional(equilibrium()) : std::nullopt;
  }

 private:
  static constexpr std::size_t kNone = static_cast<std::size_t>(-1);

  /// Finds each module in the core, and each of its facets; false if the robot does not contain it.
  bool match() {
    const auto modules = robot_.modules();
    const auto core = whole_.core_.modules();
    if (modules.size() < core.size() || modules.size() > core.size() + kNewMax) {
      return false;
    }
    std::size_t next = 0;
    for (std::size_t i = 0; i < modules.size(); ++i) {
      const bool is_core = next < core.size() && modules[i].cell == core[next].cell;
      core_of_.push_back(is_core ? next++ : kNone);
      if (!is_core) {
        new_.push_back(i);
      }
    }
    return next == core.size() && match_facets();
  }

  bool match_facets() {
    const auto core = whole_.core_.facets();
    std::size_t next = 0;
    for (const model::Facet& facet : robot_.facets()) {
      const std::size_t module = core_of_[at(facet.module)];
      const bool is_core = module != kNone;
      if (is_core && (next == core.size() || at(core[next].module) != module ||
                      core[next].direction != facet.direction)) {
        return false;
      }
      facet_of_core_.push_back(is_core ? next++ : kNone);
    }
    return next == core.size();
  }

  /// The place of a module among those that the dense system is about.
  std::size_t place_of(std::size_t module) {
    const auto found = std::ranges::find(special_, module);
    if (found == special_.end()) {
      special_.push_back(module);
      return special_.size() - 1;
    }
    return static_cast<std::size_t>(found - special_.begin());
  }

  bool add_loads() {
    for (std::size_t i = 0; i < core_of_.size(); ++i) {
      const Vec& load = robot_.loads()[i];
      if (core_of_[i] == kNone) {
        loads_.emplace_back(place_of(i), load);
        continue;
      }
      const Vec& before = whole_.core_.loads()[core_of_[i]];
      if (load != before) {
        Vec more = load;
        for (std::size_t k = 0; k < 6; ++k) {
          more[k] -= before[k];
        }
        loads_.emplace_back(place_of(i), more);
      }
    }
    return special_.size() <= kChangedMax;
  }

  /// Beams that the core does not have; all of them must end at a new module.
  bool add_beams() {
    std::size_t shared_count = 0;
    for (const model::Connection& pair : robot_.connections()) {
      const bool is_core = core_of_[at(pair.a)] != kNone && core_of_[at(pair.b)] != kNone;
      shared_count += is_core ? 1 : 0;
      if (!is_core) {
        place_of(at(pair.a));
        place_of(at(pair.b));
        beams_.push_back(pair);
      }
    }
    return shared_count == whole_.core_.connections().size();
  }

  ContactState state_of_core(std::size_t facet) const {
    const std::size_t core = facet_of_core_[facet];
    return core == kNone ? mechanics::kStuck : whole_.system_->facets()[core].state;
  }

  FacetState facet_state(std::size_t facet, const ContactState& state) const {
    const model::Facet& found = robot_.facets()[facet];
    return {.module = at(found.module),
            .direction = found.direction,
            .is_bonded = found.is_bonded(),
            .state = state};
  }

  /// S, by places of special modules.
  void stiffen(std::vector<Mat6<double>>& s, std::size_t count) {
    const model::LatticeBeam<double>& beam = whole_.system_->beam();
    const auto block = [&](std::size_t row, std::size_t column) -> Mat6<double>& {
      return s[row * count + column];
    };
    for (const model::Connection& pair : beams_) {
      const std::size_t a = place_of(at(pair.a));
      const std::size_t b = place_of(at(pair.b));
      const base::Direction back = base::opposite(pair.direction);
      base::add_to(block(a, a), beam.block_11(pair.direction));
      base::add_to(block(a, b), beam.block_12(pair.direction));
      base::add_to(block(b, b), beam.block_11(back));
      base::add_to(block(b, a), beam.block_12(back));
    }
    const auto& law = whole_.system_->law();
    for (std::size_t i = 0; i < states_.size(); ++i) {
      if (facet_of_core_[i] != kNone && states_[i] == state_of_core(i)) {
        continue;
      }
      const std::size_t place = place_of(at(robot_.facets()[i].module));
      base::add_to(block(place, place), law.tangent(facet_state(i, states_[i])));
      if (facet_of_core_[i] != kNone) {
        Mat6<double> before = law.tangent(facet_state(i, state_of_core(i)));
        for (double& value : before.values) {
          value = -value;
        }
        base::add_to(block(place, place), before);
      }
    }
  }

  /// U of special module `column` at special module `row`, both of the core.
  Mat6<double> flexibility(std::size_t row, std::size_t column) const {
    Mat6<double> g;
    for (int k = 0; k < 6; ++k) {
      const Vec& u =
          (*columns_[column])[static_cast<std::size_t>(k)].refined[core_of_[special_[row]]];
      for (int i = 0; i < 6; ++i) {
        g.at(i, k) = u[static_cast<std::size_t>(i)];
      }
    }
    return g;
  }

  /// Displacements of the special modules, then of all, for the present states.
  bool solve_for_states() {
    for (std::size_t i = 0; i < states_.size(); ++i) {
      if (facet_of_core_[i] == kNone || states_[i] != state_of_core(i)) {
        place_of(at(robot_.facets()[i].module));
      }
    }
    const std::size_t count = special_.size();
    if (count > kChangedMax || !find_columns()) {
      return false;
    }
    std::vector<Mat6<double>> s(count * count);
    stiffen(s, count);
    std::vector<Vec> p(count, Vec{});
    for (const auto& [place, load] : loads_) {
      base::add_to(p[place], load);
    }
    DenseSystem system(6 * count);
    std::vector<double> x(6 * count, 0.0);
    for (std::size_t row = 0; row < count; ++row) {
      fill_row(row, s, p, system, x);
    }
    if (!system.factor()) {
      return false;
    }
    system.solve(x);
    combine(x, s, p);
    return true;
  }

  bool find_columns() {
    columns_.assign(special_.size(), nullptr);
    for (std::size_t i = 0; i < special_.size(); ++i) {
      const std::size_t core = core_of_[special_[i]];
      if (core != kNone) {
        columns_[i] = whole_.column(core);
        if (columns_[i] == nullptr) {
          return false;
        }
      }
    }
    return true;
  }

  /// u_i + sum over j of G_ij (S u)_j = u_0i + sum of G_ij p_j; of a new module (S u)_m = f_m.
  void fill_row(std::size_t row, const std::vector<Mat6<double>>& s, const std::vector<Vec>& p,
                DenseSystem& system, std::vector<double>& x) {
    const std::size_t count = special_.size();
    const auto add_right = [&](const Vec& right) {
      for (std::size_t k = 0; k < 6; ++k) {
        x[6 * row + k] += right[k];
      }
    };
    if (columns_[row] == nullptr) {
      for (std::size_t column = 0; column < count; ++column) {
        add_block(system, row, column, s[row * count + column], 1);
      }
      add_right(p[row]);
      return;
    }
    for (std::size_t k = 0; k < 6; ++k) {
      system.at(6 * row + k, 6 * row + k) = 1;
    }
    add_right(whole_.own_.refined[core_of_[special_[row]]]);
    for (std::size_t j = 0; j < count; ++j) {
      if (columns_[j] == nullptr) {
        continue;
      }
      const Mat6<double> g = flexibility(row, j);
      for (std::size_t column = 0; column < count; ++column) {
        const Mat6<double>& block = s[j * count + column];
        if (largest_of(block) > 0) {
          add_block(system, row, column, product(g, block), 1);
        }
      }
      add_right(product(g, p[j]));
    }
  }

  static double largest_of(const Mat6<double>& block) {
    double size = 0;
    for (const double value : block.values) {
      size = std::max(size, std::abs(value));
    }
    return size;
  }

  void combine(const std::vector<double>& x, const std::vector<Mat6<double>>& s,
               const std::vector<Vec>& p) {
    const std::size_t count = special_.size();
    const auto part = [&](std::size_t place) {
      Vec u{};
      std::copy_n(x.begin() + static_cast<std::ptrdiff_t>(6 * place), 6, u.begin());
      return u;
    };
    Answer sum = whole_.own_;
    for (std::size_t j = 0; j < count; ++j) {
      if (columns_[j] == nullptr) {
        continue;
      }
      Vec r = p[j];
      for (std::size_t k = 0; k < count; ++k) {
        const Vec force = product(s[j * count + k], part(k));
        for (std::size_t i = 0; i < 6; ++i) {
          r[i] -= force[i];
        }
      }
      for (std::size_t k = 0; k < 6; ++k) {
        add(sum.refined, r[k], (*columns_[j])[k].refined);
        add(sum.rough, r[k], (*columns_[j])[k].rough);
      }
    }
    displacement_.assign(core_of_.size(), Vec{});
    alternative_.assign(core_of_.size(), Vec{});
    for (std::size_t i = 0; i < core_of_.size(); ++i) {
      const bool is_core = core_of_[i] != kNone;
      displacement_[i] = is_core ? sum.refined[core_of_[i]] : part(place_of(i));
      alternative_[i] = is_core ? sum.rough[core_of_[i]] : displacement_[i];
    }
  }

  static void add(Vecs& sum, double factor, const Vecs& more) {
    if (factor == 0) {
      return;
    }
    for (std::size_t i = 0; i < sum.size(); ++i) {
      base::add_times(sum[i], factor, more[i]);
    }
  }

  ContactStates prescribed() const {
    ContactStates states;
    for (std::size_t i = 0; i < states_.size(); ++i) {
      const FacetState facet = facet_state(i, states_[i]);
      states.push_back(whole_.system_->law().state_at(facet, displacement_[facet.module]));
    }
    return states;
  }

  bool is_doubtful() const {
    for (std::size_t i = 0; i < states_.size(); ++i) {
      const FacetState facet = facet_state(i, states_[i]);
      const Vec force = whole_.system_->law().trial_force(facet, displacement_[facet.module]);
      if (solver::may_have_second_state(states_[i], force)) {
        return true;
      }
    }
    return false;
  }

  solver::Equilibrium equilibrium() {
    solver::Equilibrium found;
    found.outcome = solver::Outcome::kSettled;
    found.law = ContactLaw::kRegularised;
    found.gamma = whole_.system_->ground().gamma;
    found.displacement = std::move(displacement_);
    found.alternative = std::move(alternative_);
    found.contact = states_;
    for (std::size_t i = 0; i < states_.size(); ++i) {
      const FacetState facet = facet_state(i, states_[i]);
      Vec force = whole_.system_->law().force(facet, found.displacement[facet.module]);
      for (double& component : force) {
        component = -component;
      }
      found.facet_force.push_back(force);
    }
    return found;
  }

  CoreResponse& whole_;
  const model::Robot& robot_;
  std::vector<std::size_t> core_of_;                ///< By module; kNone of new ones.
  std::vector<std::size_t> new_;                    ///< Modules.
  std::vector<std::size_t> facet_of_core_;          ///< By facet; kNone of those of new modules.
  std::vector<std::size_t> special_;                ///< Modules of the dense system.
  std::vector<std::pair<std::size_t, Vec>> loads_;  ///< By place in special_.
  std::vector<model::Connection> beams_;            ///< That end at a new module.
  std::vector<const Column*> columns_;              ///< By place; null of new modules.
  ContactStates states_;
  Vecs displacement_;
  Vecs alternative_;
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
    const std::vector<model::Loads>& loads) {
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
    for (std::size_t k = 0; k < 6; ++k) {
      rest[module][k] -= force[k];
    }
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
const CoreResponse::Column* CoreResponse::column(std::size_t module) {
  const auto found = columns_.find(module);
  if (found != columns_.end()) {
    return &found->second;
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
  Column column;
  std::ranges::move(*six, column.begin());
  return &columns_.emplace(module, std::move(column)).first->second;
}

std::optional<solver::Equilibrium> CoreResponse::solve(const model::Robot& robot) {
  const std::size_t column_bytes = 12 * sizeof(Vec) * core_.modules().size();
  if (columns_.size() * column_bytes > kColumnBytesMax) {
    columns_.clear();
  }
  return Grown(*this, robot).solve();
}

}  // namespace holdfast::plan
