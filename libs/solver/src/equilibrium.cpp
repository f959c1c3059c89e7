// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/solver/equilibrium.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

#include "holdfast/base/check.hpp"
#include "multigrid/multigrid.hpp"
#include "precise_refinement.hpp"

namespace holdfast::solver {
namespace {

using base::Mat6;
using base::Vec6;
using mechanics::ContactLaw;
using mechanics::ContactState;

/// The first step removes most of the rounding error, the second measures what is left.
constexpr int kRefinementCount = 2;

/// If the last step still moves something by more than this share, digits are missing.
constexpr double kRefinedShare = 1e-3;

/// Halvings of the bracket in the line search, to the resolution of double.
constexpr int kLineStepMax = 60;

/// Up to here the direct solver is as fast, and exact.
constexpr std::size_t kDirectCountMax = 128;

/// The unilateral law takes dozens of steps that change a few facets each, and its weak springs
/// cost multigrid digits. So up to here the direct solver, which makes only some columns again, is
/// faster if no more blocks than this fill in per node.
constexpr std::size_t kUnilateralCountMax = 6000;
constexpr std::size_t kUnilateralFillMax = 16;

/// What the factorization takes: for a block, upper and lower; for a node, the diagonal and its
/// inverse; for an edge, its own block.
constexpr std::size_t kBlockBytes = 2 * sizeof(Mat6<double>) + 24;
constexpr std::size_t kNodeBytes = 3 * sizeof(Mat6<double>) + 120;
constexpr std::size_t kEdgeBytes = sizeof(Mat6<double>) + 64;
constexpr std::size_t kNoLimit = std::numeric_limits<std::size_t>::max();

/// Multigrid's error while contact states are sought, as a share of the first. The regularised law
/// may have several answers, and the one meant is that of Newton's path: where a facet is so near
/// to another state that the error could decide, that step goes on, a factor at a time, down to the
/// finest.
constexpr double kLooseTolerance = 1e-3;
constexpr double kPathFactor = 0.1;
constexpr double kFinestTolerance = 1e-9;

/// How far a facet's force may be off: so many times what the preconditioner would still change it
/// by, and such a share of what it would change any facet by.
constexpr double kCorrectionFactor = 3;
constexpr double kCorrectionShare = 0.3;

/// Up to so many iterations to the alternative solution the tolerance means what it says.
constexpr double kBriskIterations = 8;

/// Slender robots, those that need double precision, are solved so much more exactly: most of their
/// energy is that of a sag that is found first. Without it a bridge of 41,600 is off by 2e-4.
constexpr double kSlenderShare = 0.3;

/// In a thin robot one beam may have most of the error's energy. So that energy must not be able to
/// change a load ratio by more than this times the tolerance; the estimate of the energy is low by
/// a third once in a while.
constexpr double kThinError = 2;

/// The solution that is compared with the last one is so much farther from convergence.
constexpr double kAlternativeFactor = 10;

std::size_t node_index(std::int32_t node) { return static_cast<std::size_t>(node); }

double dot_all(const std::vector<Vec6<double>>& a, const std::vector<Vec6<double>>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    sum += base::dot(a[i], b[i]);
  }
  return sum;
}

/// a + factor b
Vec6<double> sum(Vec6<double> a, double factor, const Vec6<double>& b) {
  for (std::size_t k = 0; k < 6; ++k) {
    a[k] += factor * b[k];
  }
  return a;
}

std::vector<Vec6<double>> sum(std::vector<Vec6<double>> a, double factor,
                              const std::vector<Vec6<double>>& b) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    a[i] = sum(a[i], factor, b[i]);
  }
  return a;
}

/// States in a form that can be compared and remembered.
std::vector<std::int8_t> code_of(const std::vector<ContactState>& states) {
  std::vector<std::int8_t> code;
  code.reserve(states.size());
  for (const ContactState& state : states) {
    const int tilt = 3 * (state.tilt_x + 1) + (state.tilt_y + 1);
    code.push_back(static_cast<std::int8_t>(state.pressed ? tilt : -1));
  }
  return code;
}

}  // namespace

EquilibriumSolver::EquilibriumSolver(const model::Robot& robot, EquilibriumOptions options)
    : robot_(robot),
      options_(std::move(options)),
      weight_n_(model::module_weight_n(robot.material())),
      beam_(mechanics::beam_stiffness(model::beam_section(robot.material()))) {
  const auto modules = robot.modules();
  node_of_module_.assign(modules.size(), -1);
  std::int32_t next = 0;
  for (std::size_t i = 0; i < modules.size(); ++i) {
    if (modules[i].support != model::Support::kFixed) {
      node_of_module_[i] = next++;
    }
    if (modules[i].support == model::Support::kGround) {
      facets_.push_back({{.module = i, .state = {}}});
    }
  }
  choose_method();
}

EquilibriumSolver::~EquilibriumSolver() = default;

void EquilibriumSolver::choose_method() {
  const std::size_t node_count = free_count();
  Method method = options_.method;
  if (method == Method::kAutomatic && node_count <= kDirectCountMax) {
    method = Method::kDirect;
  }
  if (method == Method::kDirect) {
    const bool is_limited = options_.fill_max < kNoLimit / (node_count + 1);
    make_direct(is_limited ? options_.fill_max * node_count : kNoLimit);
  } else {
    make_multigrid(options_.precision);
  }
}

/// None is left if it is too large.
void EquilibriumSolver::make_multigrid(Precision precision) {
  if (Multigrid::bytes_for(free_count(), precision) > options_.memory_bytes_max) {
    multigrid_.reset();
  } else if (multigrid_) {
    multigrid_->set_precision(precision);
  } else {
    lu_.reset();
    multigrid_ =
        std::make_unique<Multigrid>(robot_, MultigridOptions{.precision = precision,
                                                             .may_yield = !options_.is_bonded,
                                                             .thread_count = options_.thread_count,
                                                             .progress = options_.progress});
  }
}

/// After an attempt that did not get there: multigrid in double precision, and the direct solver;
/// small robots the other way round. Returns whether there is something to try.
bool EquilibriumSolver::try_otherwise() {
  if (options_.method == Method::kDirect) {
    return false;
  }
  const bool may_be_direct = options_.method == Method::kAutomatic && !has_tried_direct_;
  const bool prefers_direct = free_count() <= kUnilateralCountMax;
  has_tried_double_ = has_tried_double_ || options_.precision == Precision::kDouble;
  if (!has_tried_double_ && !(may_be_direct && prefers_direct)) {
    has_tried_double_ = true;
    make_multigrid(Precision::kDouble);
    return multigrid_ != nullptr || try_otherwise();
  }
  if (may_be_direct) {
    has_tried_direct_ = true;
    make_direct(kNoLimit);
    return lu_.has_value() || try_otherwise();
  }
  return false;
}

std::size_t EquilibriumSolver::free_count() const {
  return robot_.modules().size() - robot_.fixed_count();
}

/// No factorization is left if it is too large.
void EquilibriumSolver::make_direct(std::size_t block_count_max) {
  const std::size_t node_count = free_count();
  std::vector<Edge> edges;
  edges.reserve(robot_.connections().size());
  for (const model::Connection& connection : robot_.connections()) {
    const Edge edge{node_of_module_[node_index(connection.a)],
                    node_of_module_[node_index(connection.b)]};
    if (edge.a >= 0 && edge.b >= 0) {
      edges.push_back(edge);
    }
  }
  const std::size_t always = kNodeBytes * node_count + kEdgeBytes * edges.size();
  const std::size_t memory = options_.memory_bytes_max;
  const std::size_t affordable = memory > always ? (memory - always) / kBlockBytes : 0;
  lu_.emplace(node_count, edges, std::min(affordable, block_count_max));
  if (lu_->is_too_large()) {
    lu_.reset();
  } else {
    multigrid_.reset();
    assemble();
  }
}

/// Everything but the contact: K11 of every beam end on the diagonal, K12 off it (Eqs. 3, 5).
void EquilibriumSolver::assemble() {
  std::array<Mat6<double>, base::kDirectionCount> k11;
  std::array<Mat6<double>, base::kDirectionCount> k12;
  for (const base::Direction direction : base::kDirections) {
    const auto i = static_cast<std::size_t>(base::index(direction));
    k11[i] = mechanics::block_11(beam_, direction);
    k12[i] = mechanics::block_12(beam_, direction);
  }
  diagonal_.resize(free_count());
  std::size_t edge = 0;
  for (const model::Connection& connection : robot_.connections()) {
    const std::int32_t a = node_of_module_[node_index(connection.a)];
    const std::int32_t b = node_of_module_[node_index(connection.b)];
    const auto direction = static_cast<std::size_t>(base::index(connection.direction));
    if (a >= 0) {
      base::add_to(diagonal_[node_index(a)], k11[direction]);
    }
    if (b >= 0) {
      base::add_to(diagonal_[node_index(b)], k11[direction ^ 1U]);
    }
    if (a >= 0 && b >= 0) {
      lu_->set_edge(edge++, k12[direction]);
    }
  }
  for (std::size_t node = 0; node < diagonal_.size(); ++node) {
    lu_->set_diagonal(node, diagonal_[node]);
  }
}

Method EquilibriumSolver::method_for(ContactLaw law) {
  const std::size_t node_count = free_count();
  if (multigrid_ && options_.method == Method::kAutomatic && law == ContactLaw::kUnilateral &&
      node_count <= kUnilateralCountMax) {
    make_direct(kUnilateralFillMax * node_count);
  }
  return multigrid_ ? Method::kMultigrid : Method::kDirect;
}

Equilibrium EquilibriumSolver::solve(const ContactOptions& contact) {
  Equilibrium result;
  result.law = contact.law;
  if (!lu_ && !multigrid_) {
    result.outcome = Outcome::kTooLarge;
    return result;
  }
  set_law(contact);
  const std::size_t made_before = lu_ ? lu_->made_column_count() : 0;
  const int iterations_before = multigrid_ ? multigrid_->iteration_count() : 0;
  result.outcome = iterate(result);
  if (result.outcome == Outcome::kSettled) {
    finish(result);
  }
  if (result.outcome == Outcome::kTooSlow && try_otherwise()) {
    return solve(contact);
  }
  if (lu_) {
    result.made_column_count = lu_->made_column_count() - made_before;
  } else if (multigrid_) {
    result.method = Method::kMultigrid;
    result.precision = multigrid_->precision();
    result.iteration_count = multigrid_->iteration_count() - iterations_before;
  }
  return result;
}

/// All facets stuck.
void EquilibriumSolver::set_law(const ContactOptions& contact) {
  method_for(contact.law);
  const model::Material& material = robot_.material();
  ground_ = mechanics::ground_facet(model::beam_section(material), material.facet_mm, contact.gamma,
                                    contact.law);
  if (multigrid_) {
    multigrid_->set_law(ground_);
  }
  for (Facet& facet : facets_) {
    facet = {{.module = facet.module, .state = {}}};
    set_tangent(facet);  // Always: the law may be another one than before.
  }
}

bool EquilibriumSolver::set_contact(const ContactOptions& contact,
                                    const std::vector<ContactState>& states) {
  if (!lu_ && !multigrid_) {
    return false;
  }
  set_law(contact);
  for (Facet& facet : facets_) {
    const ContactState& state = states[facet.module];
    set_facet(facet, state, contact.law == ContactLaw::kRegularised || state.pressed);
  }
  return true;
}

std::optional<std::vector<Vec6<double>>> EquilibriumSolver::respond(const std::vector<Vec>& force,
                                                                    double tolerance) {
  if (multigrid_) {
    multigrid_->set_load(force);
    return multigrid_->solve(tolerance) ? std::optional(multigrid_->displacement()) : std::nullopt;
  }
  if (!lu_->factor()) {
    return std::nullopt;
  }
  return solve_directly(force);
}

/// From loads to displacements, both by module; what is on fixed modules means nothing.
std::vector<Vec6<double>> EquilibriumSolver::solve_directly(const std::vector<Vec>& load) const {
  std::vector<Vec> x(diagonal_.size());
  for (std::size_t i = 0; i < load.size(); ++i) {
    if (node_of_module_[i] >= 0) {
      x[node_index(node_of_module_[i])] = load[i];
    }
  }
  lu_->solve(x);
  return by_module(x);
}

Outcome EquilibriumSolver::iterate(Equilibrium& result) {
  const bool is_linear = options_.is_bonded || facets_.empty();
  tolerance_ = is_linear ? kAlternativeFactor * options_.tolerance : loose_tolerance();
  Outcome outcome = Outcome::kSettled;
  if (is_linear) {
    outcome = solve_linear(result) ? Outcome::kSettled : Outcome::kSingular;
  } else {
    outcome = result.law == ContactLaw::kRegularised ? iterate_regularised(result)
                                                     : iterate_unilateral(result);
  }
  return outcome == Outcome::kSingular && multigrid_ ? Outcome::kTooSlow : outcome;
}

/// For a start.
double EquilibriumSolver::loose_tolerance() const {
  return std::max(kAlternativeFactor * options_.tolerance, kLooseTolerance);
}

/// Once the states hold still: whether the solution is good enough to say so. If not, it will be.
bool EquilibriumSolver::is_tight_now() {
  const double tight = kAlternativeFactor * options_.tolerance;
  return !multigrid_ || std::exchange(tolerance_, std::min(tolerance_, tight)) <= tight;
}

void EquilibriumSolver::set_tangent(const Facet& facet) {
  if (multigrid_) {
    multigrid_->set_facet(facet.module, facet.state, facet.is_held);
    return;
  }
  const std::size_t node = node_index(node_of_module_[facet.module]);
  Mat6<double> block = diagonal_[node];
  base::add_to(block, mechanics::contact_tangent(ground_, facet.state, facet.is_held));
  lu_->set_diagonal(node, block);
}

/// Returns whether anything differs; only then the factorization has to be made again.
bool EquilibriumSolver::set_facet(Facet& facet, const ContactState& state, bool is_held) {
  if (facet.state == state && facet.is_held == is_held) {
    return false;
  }
  facet.state = state;
  facet.is_held = is_held;
  set_tangent(facet);
  return true;
}

/// Takes over new states; returns whether any of them differs.
bool EquilibriumSolver::set_states(const std::vector<ContactState>& states) {
  bool is_changed = false;
  for (std::size_t i = 0; i < facets_.size(); ++i) {
    is_changed = set_facet(facets_[i], states[i], facets_[i].is_held) || is_changed;
  }
  return is_changed;
}

std::vector<ContactState> EquilibriumSolver::present_states() const {
  std::vector<ContactState> states;
  states.reserve(facets_.size());
  for (const Facet& facet : facets_) {
    states.push_back(facet.state);
  }
  return states;
}

std::vector<ContactState> EquilibriumSolver::states_at(const std::vector<Vec>& displacement) const {
  std::vector<ContactState> states;
  states.reserve(facets_.size());
  for (const Facet& facet : facets_) {
    states.push_back(mechanics::contact_state(
        ground_, mechanics::trial_force(ground_, displacement[facet.module])));
  }
  return states;
}

/// Whether every facet's state is that of the exact solution. Where the iteration converges slowly
/// the preconditioner misses more of the error.
bool EquilibriumSolver::are_states_certain(const std::vector<Vec>& displacement) const {
  if (!multigrid_) {
    return true;
  }
  std::vector<double> errors;  // N, torques counted at half a width.
  errors.reserve(facets_.size());
  for (const Facet& facet : facets_) {
    const Vec force = mechanics::trial_force(ground_, multigrid_->facet_correction(facet.module));
    errors.push_back(std::abs(force[2]) +
                     std::max(std::abs(force[3]), std::abs(force[4])) / ground_.half_width);
  }
  const double pace = std::max(1.0, multigrid_->last_count() / kBriskIterations);
  const double common = kCorrectionShare * *std::ranges::max_element(errors);
  for (std::size_t i = 0; i < facets_.size(); ++i) {
    const double error = kCorrectionFactor * pace * std::max(errors[i], common);
    const Vec force = mechanics::trial_force(ground_, displacement[facets_[i].module]);
    Vec more = force;
    Vec less = force;
    more[2] -= error;
    less[2] += error;
    if (mechanics::contact_state(ground_, more) != mechanics::contact_state(ground_, less)) {
      return false;
    }
  }
  return true;
}

/// From one vector per node to one per module; fixed modules get zero.
std::vector<Vec6<double>> EquilibriumSolver::by_module(const std::vector<Vec>& by_node) const {
  std::vector<Vec> vectors(node_of_module_.size(), Vec{});
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    if (node_of_module_[i] >= 0) {
      vectors[i] = by_node[node_index(node_of_module_[i])];
    }
  }
  return vectors;
}

/// Displacements for the present states, under the weight.
bool EquilibriumSolver::solve_linear(Equilibrium& result) {
  result.steps += multigrid_ && !multigrid_->is_new() ? 0 : 1;
  if (multigrid_) {
    if (!multigrid_->solve(tolerance_)) {
      return false;
    }
    result.displacement = multigrid_->displacement();
    return true;
  }
  if (!lu_->factor()) {
    return false;
  }
  std::vector<Vec> x(diagonal_.size(), Vec{0, 0, -weight_n_, 0, 0, 0});
  lu_->solve(x);
  result.displacement = by_module(x);
  return true;
}

/// Displacements good enough to look up the states that the exact ones prescribe.
bool EquilibriumSolver::solve_for_states(Equilibrium& result) {
  while (solve_linear(result)) {
    if (are_states_certain(result.displacement) || tolerance_ <= kFinestTolerance) {
      return true;
    }
    tolerance_ = std::max(kPathFactor * tolerance_, kFinestTolerance);
  }
  return false;
}

/// From the facets' present states on.
Outcome EquilibriumSolver::iterate_regularised(Equilibrium& result) {
  std::set<std::vector<std::int8_t>> seen;
  for (int step = 0; step < options_.step_count_max; ++step) {
    if (!solve_for_states(result)) {
      return Outcome::kSingular;
    }
    const std::vector<ContactState> states = states_at(result.displacement);
    if (!set_states(states)) {
      if (is_tight_now()) {
        return Outcome::kSettled;
      }
      continue;
    }
    if (!seen.insert(code_of(states)).second) {
      return Outcome::kNotSettled;
    }
    tolerance_ = loose_tolerance();
  }
  return Outcome::kNotSettled;
}

Outcome EquilibriumSolver::iterate_unilateral(Equilibrium& result) {
  Outcome outcome = minimise(result);
  while (outcome == Outcome::kSettled && update_held()) {
    outcome = minimise(result);
  }
  return outcome;
}

/// Newton's method with an exact line search on the convex energy, for the present held facets.
Outcome EquilibriumSolver::minimise(Equilibrium& result) {
  std::vector<Vec> current;
  for (int step = 0; step < options_.step_count_max; ++step) {
    if (!solve_linear(result)) {
      return Outcome::kSingular;
    }
    if (!set_states(states_at(result.displacement))) {
      if (is_tight_now()) {
        return Outcome::kSettled;
      }
      continue;
    }
    if (!current.empty()) {
      const std::vector<Vec> direction = sum(result.displacement, -1, current);
      result.displacement = sum(current, search_line(current, direction), direction);
      set_states(states_at(result.displacement));
    }
    current = result.displacement;
  }
  return Outcome::kNotSettled;
}

/// Where the energy along a line is least: the root of its slope, which never decreases.
double EquilibriumSolver::search_line(const std::vector<Vec>& from,
                                      const std::vector<Vec>& direction) const {
  double slope = dot_all(internal_force(from), direction);
  for (const Vec& step : direction) {  // A fixed module's is zero.
    slope += weight_n_ * step[2];
  }
  const double curvature = dot_all(internal_force(direction), direction);
  const auto slope_at = [&](double length) {
    double slope_here = slope + length * curvature;
    for (const Facet& facet : facets_) {
      const Vec u = sum(from[facet.module], length, direction[facet.module]);
      const ContactState state =
          mechanics::contact_state(ground_, mechanics::trial_force(ground_, u));
      slope_here += base::dot(mechanics::contact_force(ground_, state, facet.is_held, u),
                              direction[facet.module]);
    }
    return slope_here;
  };
  if (slope_at(1) <= 0) {
    return 1;
  }
  double low = 0;
  double high = 1;
  for (int i = 0; i < kLineStepMax && low < high; ++i) {
    const double middle = (low + high) / 2;
    (slope_at(middle) <= 0 ? low : high) = middle;
  }
  return high;
}

/// Releases open facets, holds pressed ones. Returns whether anything changed; a facet changes at
/// most twice, so this says no in the end.
bool EquilibriumSolver::update_held() {
  bool is_changed = false;
  for (Facet& facet : facets_) {
    const bool is_held = facet.state.pressed || (facet.is_held && facet.was_released);
    facet.was_released = facet.was_released || !is_held;
    is_changed = set_facet(facet, facet.state, is_held) || is_changed;
  }
  return is_changed;
}

/// Force that the beams take from every module.
std::vector<Vec6<double>> EquilibriumSolver::internal_force(
    const std::vector<Vec>& displacement) const {
  std::vector<Vec> force(displacement.size(), Vec{});
  for (const model::Connection& connection : robot_.connections()) {
    const auto a = node_index(connection.a);
    const auto b = node_index(connection.b);
    base::add_to(force[a], mechanics::end_force(beam_, connection.direction, displacement[a],
                                                displacement[b]));
    base::add_to(force[b], mechanics::end_force(beam_, base::opposite(connection.direction),
                                                displacement[b], displacement[a]));
  }
  return force;
}

/// The last digits, then everything that follows from the displacements.
void EquilibriumSolver::finish(Equilibrium& result) {
  result.gamma = ground_.gamma;
  if (!(multigrid_ ? finish_multigrid(result) : finish_direct(result))) {
    result.outcome = Outcome::kTooSlow;
    return;
  }
  const std::size_t count = robot_.modules().size();
  result.contact.assign(count, ContactState{.pressed = false});
  result.ground_force.assign(count, Vec{});
  result.open_but_held_count = open_but_held_count();
  for (const Facet& facet : facets_) {
    result.contact[facet.module] = facet.state;
    const Vec force = mechanics::contact_force(ground_, facet.state, facet.is_held,
                                               result.displacement[facet.module]);
    for (std::size_t k = 0; k < 6; ++k) {
      result.ground_force[facet.module][k] = -force[k];
    }
  }
  if (result.open_but_held_count > 0) {
    compare_with_free_facets(result);
  }
}

/// Returns false if it does not get there.
bool EquilibriumSolver::finish_multigrid(Equilibrium& result) {
  result.alternative = std::move(result.displacement);
  // Where convergence is slow r . M^-1 r misses more of the error.
  const double pace = std::min(1.0, kBriskIterations / multigrid_->last_count());
  const double share = multigrid_->precision() == Precision::kDouble ? kSlenderShare : 1;
  // One iteration at least: else the two answers are the same, and say nothing about the error.
  const double energy_error_max =
      multigrid_->is_thin()
          ? kThinError * options_.tolerance / model::load_ratio_per_energy_norm(robot_.material())
          : std::numeric_limits<double>::infinity();
  if (!multigrid_->solve(options_.tolerance * share * pace * pace * pace, 1, energy_error_max)) {
    return false;
  }
  result.energy_error = multigrid_->energy_error();
  result.displacement = multigrid_->displacement();
  return true;
}

/// Returns false if there are no digits left.
bool EquilibriumSolver::finish_direct(Equilibrium& result) {
  for (int step = 0; step < kRefinementCount; ++step) {
    refine(result);
  }
  if (is_refined(result) && !options_.is_precise) {
    return true;
  }
  const bool may_go_without = ground_.law == ContactLaw::kUnilateral && open_but_held_count() == 0;
  if (may_go_without && refine_without_weak_springs(result)) {
    return true;
  }
  return refine_precisely(result);
}

/// Returns false if that does not settle, or the facets' states are then other ones.
bool EquilibriumSolver::refine_precisely(Equilibrium& result) {
  PreciseRefinement refinement(robot_, ground_,
                               std::vector<FacetState>(facets_.begin(), facets_.end()));
  const bool is_found = refinement.run(
      result.displacement, [&](std::vector<Vec>& load) { load = solve_directly(load); });
  const std::vector<ContactState> states = refinement.states();
  const bool is_consistent =
      options_.is_bonded || std::ranges::equal(facets_, states, {}, &Facet::state);
  if (!is_found || !is_consistent) {
    return false;
  }
  result.displacement = refinement.high();
  result.displacement_low = refinement.low();
  result.alternative = result.displacement;
  return true;
}

void EquilibriumSolver::set_gamma(double gamma) {
  ground_.gamma = gamma;
  for (const Facet& facet : facets_) {
    set_tangent(facet);
  }
}

/// The weak springs keep the matrix regular until the states are found; a robot that stands does
/// without them then, unless feet are yet to be freed. Leaves everything as it was if this one does
/// not.
bool EquilibriumSolver::refine_without_weak_springs(Equilibrium& result) {
  const double gamma = ground_.gamma;
  const std::vector<Vec> displacement = result.displacement;
  set_gamma(0);
  if (lu_->factor() && refine_precisely(result)) {
    result.gamma = 0;
    return true;
  }
  result.displacement = displacement;
  set_gamma(gamma);
  HOLDFAST_CHECK(lu_->factor());  // As it was before.
  return false;
}

int EquilibriumSolver::open_but_held_count() const {
  return static_cast<int>(std::ranges::count_if(facets_, [&](const Facet& facet) {
    return ground_.law == ContactLaw::kUnilateral && !facet.state.pressed && facet.is_held;
  }));
}

/// The alternative where some facets can neither be held nor free: half open, half closed.
void EquilibriumSolver::compare_with_free_facets(Equilibrium& result) {
  for (Facet& facet : facets_) {
    set_facet(facet, facet.state, facet.is_held && facet.state.pressed);
  }
  set_states(states_at(result.displacement));
  Equilibrium free;
  const bool is_settled = minimise(free) == Outcome::kSettled;
  result.steps += free.steps;
  if (!is_settled) {
    result.outcome = Outcome::kNotSettled;  // Held is one limit, and the other is not known.
    return;
  }
  result.alternative = std::move(free.displacement);
}

/// Whether the last refinement had next to nothing to correct. On a robot so slender that bending
/// drowns in double precision's rounding, each finds something else.
bool EquilibriumSolver::is_refined(const Equilibrium& result) {
  double largest = 0;
  double change = 0;
  for (std::size_t i = 0; i < result.displacement.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      largest = std::max(largest, std::abs(result.displacement[i][k]));
      change = std::max(change, std::abs(result.displacement[i][k] - result.alternative[i][k]));
    }
  }
  return change <= kRefinedShare * largest;
}

/// Solves for the residual and adds the correction.
void EquilibriumSolver::refine(Equilibrium& result) const {
  std::vector<Vec> residual = internal_force(result.displacement);
  for (const Facet& facet : facets_) {
    base::add_to(residual[facet.module],
                 mechanics::contact_force(ground_, facet.state, facet.is_held,
                                          result.displacement[facet.module]));
  }
  std::vector<Vec> x(diagonal_.size());
  for (std::size_t i = 0; i < residual.size(); ++i) {
    if (node_of_module_[i] >= 0) {
      x[node_index(node_of_module_[i])] = sum({0, 0, -weight_n_, 0, 0, 0}, -1, residual[i]);
    }
  }
  lu_->solve(x);
  result.alternative = result.displacement;
  result.displacement = sum(result.displacement, 1, by_module(x));
}

}  // namespace holdfast::solver
