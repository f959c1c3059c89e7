// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/solver/equilibrium.hpp"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

#include "contact/regularised_contact.hpp"
#include "contact/sliding_contact.hpp"
#include "contact/unilateral_contact.hpp"
#include "system_choice.hpp"

namespace holdfast::solver {
namespace {

using mechanics::ContactLaw;

/// What a system has done since an earlier report.
Attempt attempt_since(const LinearReport& before, const LinearReport& now,
                      const Equilibrium& result) {
  return {.law = result.law,
          .outcome = result.outcome,
          .method = now.method,
          .precision = now.precision,
          .steps = now.solve_count - before.solve_count,
          .iteration_count = now.iteration_count - before.iteration_count,
          .made_column_count = now.made_column_count - before.made_column_count};
}

/// The contact states, and the forces that go with the displacements.
void take_contact(const LinearSystem& system, Equilibrium& result) {
  result.contact.clear();
  result.facet_force.clear();
  const FacetLaw<double> law = system.law().with_gamma(result.gamma);
  for (std::size_t i = 0; i < system.facets().size(); ++i) {
    const FacetState& facet = system.facets()[i];
    auto force = law.force(facet, result.displacement[facet.module]);
    if (!result.slip.empty()) {
      base::add_times(force, -1.0, SlidingContact::slip_force(system, i, result.slip[i]));
    }
    for (double& component : force) {
      component = -component;
    }
    result.contact.push_back(facet.state);
    result.facet_force.push_back(force);
  }
}

/// The search, the last digits, then everything that follows from the displacements.
/// `is_more_likely` says, when there are these digits, whether the system is likely to be solved
/// again.
template <class IsMoreLikely>
void solve_with(LinearSystem& system, ContactIteration& search, const IsMoreLikely& is_more_likely,
                Equilibrium& result) {
  using Further = LinearSystem::Further;
  result.outcome = search.run();
  if (result.outcome == Outcome::kNotSettled) {
    result.displacement = search.last_displacement();
  }
  if (result.outcome != Outcome::kSettled) {
    return;
  }
  if (system.refine(result)) {
    const bool is_kept = !system.is_exact() && is_more_likely();
    system.hand_over(result, is_kept ? Further::kMore : Further::kNothing);
    take_contact(system, result);
  } else {
    result.outcome = Outcome::kTooSlow;
  }
}

/// The alternative where some facets can neither be held nor free.
void compare_with_free_facets(UnilateralContact& contact, Equilibrium& result) {
  if (result.outcome != Outcome::kSettled || contact.open_but_held_count() == 0) {
    return;
  }
  result.open_but_held_count = contact.open_but_held_count();
  std::optional<Solution> free = contact.with_free_facets(result.displacement);
  if (!free) {
    result.outcome = Outcome::kNotSettled;  // Held is one limit, and the other is not known.
    return;
  }
  result.alternative = std::move(free->displacement);
  result.free_gamma = free->gamma;
  result.energy_error = std::max(result.energy_error, free->energy_error);
}

/// The equilibrium of slips that have settled; none if its last digits are not to be had.
std::optional<Equilibrium> slid(LinearSystem& system, const SlidingContact& search,
                                const Equilibrium& before) {
  Equilibrium result;
  result.law = before.law;
  result.outcome = Outcome::kSettled;
  result.slip = search.slips();
  if (!system.refine(result)) {
    return std::nullopt;
  }
  system.hand_over(result, LinearSystem::Further::kMore);
  if (result.displacement_low.empty()) {
    result.alternative = search.before_last();
  }
  take_contact(system, result);
  return result;
}

/// Puts all facets into their states by the exact law, without weak springs where a factorization
/// needs none. Facets that all stick are so by either law. Those that slip are
/// held by nothing, but for one where all do: how far they go together changes no force.
void take_states(LinearSystem& system, const Equilibrium& settled) {
  const std::vector<mechanics::ContactState>& contact = settled.contact;
  constexpr double kWeakSprings = 1e-6;
  const bool is_known = std::ranges::all_of(system.facets(), [](const FacetState& facet) {
    return facet.state == mechanics::kStuck && facet.is_held;
  });
  const bool is_all_stuck = are_all_stuck(settled);
  if (is_known && is_all_stuck && settled.slip.empty() && system.report().solve_count > 0) {
    return;
  }
  const bool has_springs = !system.is_exact() && !is_all_stuck;
  system.set_law({.law = ContactLaw::kUnilateral, .gamma = has_springs ? kWeakSprings : 0.0});
  const auto slips = [&](std::size_t i) {
    return !settled.slip.empty() && settled.slip[i] != std::array<double, 3>{};
  };
  bool is_any_held = system.robot().fixed_count() > 0;
  for (std::size_t i = 0; i < contact.size(); ++i) {
    is_any_held = is_any_held || (contact[i].pressed && !slips(i));
  }
  for (std::size_t i = 0; i < contact.size(); ++i) {
    const bool is_held = contact[i].pressed && (!slips(i) || !is_any_held);
    is_any_held = is_any_held || is_held;
    system.set_facet(i, contact[i], is_held);
  }
}

}  // namespace

void Equilibrium::begin_with(const Equilibrium& earlier) {
  attempts.insert(attempts.begin(), earlier.attempts.begin(), earlier.attempts.end());
  steps += earlier.steps;
  iteration_count += earlier.iteration_count;
}

bool are_all_stuck(const Equilibrium& equilibrium) {
  return std::ranges::all_of(equilibrium.contact,
                             [](const auto& state) { return state == mechanics::kStuck; });
}

mechanics::ContactState contact_of(const model::Robot& robot, const Equilibrium& equilibrium,
                                   std::size_t module) {
  const auto facets = robot.facets();
  const auto facet = std::ranges::lower_bound(facets, static_cast<std::int32_t>(module), {},
                                              &model::Facet::module);
  if (facet == facets.end() || base::at(facet->module) != module) {
    return {.pressed = false};
  }
  return equilibrium.contact[static_cast<std::size_t>(facet - facets.begin())];
}

std::vector<base::Vec6<double>> ground_forces(const model::Robot& robot,
                                              const Equilibrium& equilibrium) {
  if (equilibrium.displacement.empty() || equilibrium.facet_force.size() != robot.facets().size()) {
    return {};
  }
  std::vector<base::Vec6<double>> forces(robot.modules().size());
  for (std::size_t i = 0; i < equilibrium.facet_force.size(); ++i) {
    base::add_to(forces[base::at(robot.facets()[i].module)], equilibrium.facet_force[i]);
  }
  return forces;
}

EquilibriumSolver::EquilibriumSolver(const model::Robot& robot, EquilibriumOptions options)
    : options_(std::move(options)), choice_(std::make_unique<SystemChoice>(robot, options_)) {}

EquilibriumSolver::~EquilibriumSolver() = default;

Method EquilibriumSolver::prepare(ContactLaw law) {
  choice_->prepare(law);
  return choice_->system() != nullptr ? choice_->system()->report().method : Method::kDirect;
}

Equilibrium EquilibriumSolver::solve(const ContactOptions& contact) {
  Equilibrium result;
  if (choice_->system() == nullptr) {
    result.law = contact.law;
    result.outcome = Outcome::kTooLarge;
    return result;
  }
  do {
    attempt(contact, result);
  } while (result.outcome == Outcome::kTooSlow && choice_->try_next());
  return result;
}

/// One try with the system in use.
void EquilibriumSolver::attempt(const ContactOptions& contact, Equilibrium& result) {
  std::vector<Attempt> attempts = std::move(result.attempts);
  result = {};
  result.law = contact.law;
  choice_->prepare(contact.law);
  LinearSystem& system = *choice_->system();
  const LinearReport before = system.report();
  system.set_law(contact);
  const SecondOrderWish wish = options_.second_order;
  const bool is_checked = wish != SecondOrderWish::kNothing &&
                          (wish != SecondOrderWish::kBesideFactors || system.is_exact());
  const bool is_all_bonded = std::ranges::all_of(system.facets(), &FacetState::is_bonded);
  if (options_.is_bonded || host::all(system.robot().ranks(), is_all_bonded)) {
    BondedContact search(system, options_);
    solve_with(
        system, search, [&] { return is_checked; }, result);
  } else if (contact.law == ContactLaw::kRegularised) {
    RegularisedContact search(system, options_);
    search.go_on(contact);
    solve_with(
        system, search, [&] { return is_checked || search.has_doubts(); }, result);
  } else {
    UnilateralContact search(system, options_);
    search.go_on(contact);
    solve_with(
        system, search, [&] { return is_checked || search.open_but_held_count() > 0; }, result);
    compare_with_free_facets(search, result);
  }
  const Attempt& last = attempts.emplace_back(attempt_since(before, system.report(), result));
  result.method = last.method;
  result.precision = last.precision;
  result.steps = last.steps;
  result.iteration_count = last.iteration_count;
  result.made_column_count = last.made_column_count;
  result.attempts = std::move(attempts);
}

void EquilibriumSolver::seek_others(Equilibrium& settled) {
  if (settled.outcome != Outcome::kSettled || settled.law != ContactLaw::kRegularised ||
      options_.is_bonded) {
    return;
  }
  LinearSystem& system = *choice_->system();
  const int solve_count = system.report().solve_count;
  settled.others = RegularisedContact(system, options_).find_others(settled);
  settled.steps += system.report().solve_count - solve_count;
}

std::vector<Equilibrium> EquilibriumSolver::let_slip(const Equilibrium& settled,
                                                     const ContactOptions& contact) {
  constexpr std::size_t kSlipFillMax = 60;
  constexpr std::size_t kSlipCountMax = 3000;  // Larger ones take seconds, and lack digits.
  const model::Robot& robot = choice_->system()->robot();
  if (robot.free_count() > kSlipCountMax || robot.ranks().is_shared()) {
    return {};
  }
  EquilibriumOptions options = options_;
  options.fill_max = std::min(options.fill_max, kSlipFillMax);
  const std::unique_ptr<LinearSystem> system = DirectSystem::make(robot, options);
  if (!system) {
    return {};
  }
  system->set_law(contact);
  for (std::size_t i = 0; i < settled.contact.size(); ++i) {
    const bool is_held = contact.law == ContactLaw::kRegularised || settled.contact[i].pressed;
    system->set_facet(i, settled.contact[i], is_held);
  }
  SlidingContact search(*system, options);
  std::vector<Equilibrium> found;
  const auto goes_on = [&] {
    auto next = search.run() == Outcome::kSettled ? slid(*system, search, settled) : std::nullopt;
    if (!next) {
      return false;
    }
    found.push_back(*std::move(next));
    return true;
  };
  if (!goes_on()) {
    return {};
  }
  if (search.is_any_held()) {
    search.let_turn();
    if (!goes_on()) {
      return {};
    }
  }
  Equilibrium& first = found.front();
  const LinearReport report = system->report();
  first.method = report.method;
  first.precision = report.precision;
  first.steps = report.solve_count;
  first.attempts = {attempt_since({}, report, first)};
  return found;
}

SecondOrder EquilibriumSolver::find_second_order(const Equilibrium& settled,
                                                 const SecondOrderOptions& options) {
  take_states(*choice_->system(), settled);
  const auto make_direct = [&]() -> std::unique_ptr<LinearSystem> {
    auto beside = choice_->make_direct_beside();
    if (beside) {
      take_states(*beside, settled);
    }
    return beside;
  };
  return second_order(*choice_->system(), make_direct, settled.displacement, options);
}

std::vector<Equilibrium> EquilibriumSolver::seek_settled(const ContactOptions& contact) {
  constexpr std::size_t kModuleCountTried = 128;
  choice_->prepare(contact.law);
  LinearSystem* const system = choice_->system();
  if (system == nullptr || !system->is_exact()) {
    return {};
  }
  const bool is_small = system->robot().modules().size() <= kModuleCountTried;
  const std::size_t facet_count_max = is_small ? 24 : 8;
  if (system->facets().size() > facet_count_max) {
    return {};
  }
  system->set_law(contact);
  std::vector<Equilibrium> all;
  const auto take = [&](Solution solution) {
    Equilibrium& one = all.emplace_back();
    static_cast<Solution&>(one) = std::move(solution);
    one.outcome = Outcome::kSettled;
    take_contact(*system, one);
  };
  constexpr std::size_t kFacetCountTried = 3;
  RegularisedContact contact_search(*system, options_);
  if (is_small && system->facets().size() <= kFacetCountTried) {
    contact_search.try_all_states(take);
  } else {
    contact_search.find_from_one_foot(take);
  }
  return all;
}

}  // namespace holdfast::solver
