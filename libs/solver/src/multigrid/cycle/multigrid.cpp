// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "multigrid/cycle/multigrid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "factorization/block_kernels.hpp"
#include "holdfast/base/algebra.hpp"

namespace holdfast::solver {
namespace {

using base::at;
using mechanics::ContactLaw;
using mechanics::ContactState;

constexpr int kIterationMax = 500;

/// Memory per module: measured up to 345 bytes in single precision, up to 355 in double on slender
/// robots, to which a part of a robot adds K p.
constexpr std::size_t kBytesPerModule = 360;
constexpr std::size_t kBytesPerModuleDouble = 420;

/// Memory for each direction that a lattice has beyond six: a ball of 25,000 face-centred modules
/// takes 380 bytes a module, larger ones less.
constexpr std::size_t kBytesPerDirection = 10;
constexpr std::size_t kBytesPerDirectionDouble = 60;

/// A robot of n modules that is N long consists of N / sqrt(n / N) cubes in a row, at most, as if
/// its modules were in one bar. Rounding moves it by that number squared times what it moves a
/// cube, and where it so moves it by more than this share of the true motion, single precision is
/// not even tried: from N^3 / n = 2.5e6 on. By experiment it gives up in portals from 2.0e6 on,
/// needs dozens of iterations in bridges from 2.1e6 on, and does well in towers up to 9e6. A robot
/// that is sent on wrongly takes twice as long.
constexpr double kRoundingShare = 0.15;

/// A network of so few nodes is solved on its coarsest level, in double precision anyway.
constexpr std::size_t kTrivialCount = 48;

/// The most facets that may stay out of all clusters, one of so many nodes: the coarsest level then
/// has them all, and is factorized anew after each change. A foot of a portal has 16.
constexpr std::size_t kAloneMax = 128;
constexpr std::size_t kAloneShare = 64;

/// All facets join clusters where the robot is, on average over its length, so many times as wide
/// as they are together: it is no robot on its legs then, and can tilt on its feet as little as in
/// its middle. A ball of a million face-centred modules, on 121 of them and 50 times as wide, takes
/// 9 iterations instead of 21. (Not for cubes, whose portals on legs are at 1 and growth anywhere.)
constexpr double kWidthMax = 8;

/// What counts as thin: plates one module thick and solids have four neighbours a node and more,
/// but for their edges; full ladders have three.
constexpr std::size_t kThinCountMax = 2000;
constexpr double kThinEndCount = 3.5;

/// How far a facet's force may be off: so many times what the preconditioner would still change it
/// by, and such a share of what it would change any facet by.
constexpr double kCorrectionFactor = 3;
constexpr double kCorrectionShare = 0.3;

/// Up to so many iterations to the alternative solution the tolerance means what it says.
constexpr double kBriskIterations = 8;

/// Slender robots, those that need double precision, are solved so much more exactly: most of their
/// energy is that of a sag that is found first. Without it a bridge of 41,600 is off by 2e-4.
constexpr double kSlenderShare = 0.3;

/// One beam may have most of the error's energy in a thin robot. So that energy must not be able to
/// change a load ratio by more than this times the tolerance; the estimate of the energy is low by
/// a third once in a while.
constexpr double kThinError = 2;

/// The symmetric matrix that above the diagonal is this one.
Mat mirrored(Mat matrix) {
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < row; ++column) {
      matrix.at(row, column) = matrix.at(column, row);
    }
  }
  return matrix;
}

bool is_held_sideways(ContactLaw law, bool is_held) {
  return law == ContactLaw::kRegularised || is_held;
}

}  // namespace

std::unique_ptr<Multigrid> Multigrid::make(const model::Robot& robot,
                                           const EquilibriumOptions& options) {
  if (host::any(robot.ranks(), bytes_for(robot, options.precision) > options.memory_bytes_max)) {
    return nullptr;
  }
  return std::make_unique<Multigrid>(robot, options);
}

Multigrid::Multigrid(const model::Robot& robot, const EquilibriumOptions& options)
    : LinearSystem(robot),
      options_(options),
      precision_(options.precision),
      team_(options.thread_count, robot.modules().size()),
      network_(make_reduced_network(robot, team_)),
      ground_node_of_facet_(facets().size()) {
  for (std::size_t i = 0; i < network_.ground_beams.size(); ++i) {
    const GroundBeam& beam = network_.ground_beams[i];
    if (beam.facet != GroundBeam::kNoFacet) {
      const std::size_t facet = at(beam.facet);
      ground_node_of_facet_[facet] = ground_nodes_.size();
      ground_nodes_.push_back(
          {.node = beam.node, .facet = facet, .beam = i, .known = facets()[facet]});
    }
  }
  alone_ = nodes_alone();
  module_copies_ = ranks().make_halo(robot.own_count(), robot.part().copies);
  node_copies_ = ranks().make_halo(network_.own_count, network_.copies);
  take_loads();
}

std::size_t Multigrid::bytes_for(const model::Robot& robot, Precision precision) {
  const bool is_single = precision == Precision::kSingle;
  const auto further = at(robot.lattice().direction_count - base::kDirectionCount);
  return robot.free_count() *
         ((is_single ? kBytesPerModule : kBytesPerModuleDouble) +
          further * (is_single ? kBytesPerDirection : kBytesPerDirectionDouble));
}

bool Multigrid::set_precision(Precision precision) {
  if (host::any(ranks(), bytes_for(robot(), precision) > options_.memory_bytes_max)) {
    return false;
  }
  precision_ = precision;
  iteration_.reset();
  reference_ = 0;
  is_residual_known_ = false;
  is_stale_ = true;
  return true;
}

/// Whether it is plain from the robot's shape that single precision will not do.
bool Multigrid::is_too_slender() const {
  const double length = network_.extent;
  const auto count = static_cast<double>(model::whole_module_count(robot()));
  const double slenderness_squared = length * length * length / count;
  return network_.all_count > kTrivialCount &&
         std::numeric_limits<float>::epsilon() / 2 * slenderness_squared > kRoundingShare;
}

/// The hierarchy takes for a tangent its upper half on both sides, as it is symmetric: a facet that
/// tilts, whose torque follows its pressure, is a hinge there.
void Multigrid::take_law() {
  for (int code = 0; code < ContactState::kCodeCount; ++code) {
    const ContactState state = ContactState::from_code(code);
    for (const bool is_held : {false, true}) {
      for (const base::Direction direction : base::facet_directions(robot().lattice())) {
        const Mat tangent = mirrored(mechanics::contact_tangent(ground(direction), state, is_held));
        known_tangents_[at(base::index(direction))][at(1 + 2 * code + (is_held ? 1 : 0))] =
            beam().to_global(direction, tangent);
      }
    }
  }
  for (std::size_t facet = 0; facet < facets().size(); ++facet) {
    take_facet(facet);
  }
  is_law_new_ = true;
  is_stale_ = true;
}

std::uint8_t Multigrid::number_of(const FacetState& facet) const {
  return contact_number(facet.state, is_held_sideways(ground().law, facet.is_held));
}

void Multigrid::take_facet(std::size_t facet) {
  GroundBeam& beam = network_.ground_beams[ground_nodes_[ground_node_of_facet_[facet]].beam];
  const std::uint8_t contact = number_of(facets()[facet]);
  if (contact == beam.contact) {
    return;
  }
  beam.contact = contact;
  is_contact_new_ = true;
  is_stale_ = true;
}

void Multigrid::take_loads() {
  condense_loads();
  is_residual_known_ = false;
  is_stale_ = true;
  std::ranges::fill(x(), 0);
  reference_ = 0;
}

/// The residual changes as the loads do.
void Multigrid::take_changed_loads(const model::Loads& before) {
  const CondensedLoads condensed = std::exchange(condensed_, {});
  condense_loads();
  is_stale_ = true;
  if (!is_residual_known_) {
    return;
  }
  team_.share(0, network_.own_count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t node = begin; node < end; ++node) {
      const std::size_t module = at(network_.module[node]);
      const Vec& now = load_of(node);
      const Vec& then = condensed.of(module, before);
      if (now == then) {
        continue;
      }
      Vec left = iteration_->residual(node);
      for (std::size_t k = 0; k < 6; ++k) {
        left[k] += now[k] - then[k];
      }
      iteration_->set_residual(node, left);
    }
  });
}

/// The nodes' displacements; empty where nothing is known of them.
std::vector<double>& Multigrid::x() { return iteration_ ? iteration_->x() : no_x_; }

void Multigrid::condense_loads() {
  condensed_ = {};
  if (network_.is_reduced) {
    condensed_ = condense(robot(), network_, team_, loads(), *module_copies_);
  }
}

/// What acts on a node.
const Multigrid::Vec& Multigrid::load_of(std::size_t node) const {
  return condensed_.of(at(network_.module[node]), loads());
}

Multigrid::Vec Multigrid::displacement_of(std::int32_t node) {
  Vec u;
  std::copy_n(x().begin() + 6 * std::ptrdiff_t{node}, 6, u.begin());
  return u;
}

/// The force that the ground takes from a node whose facet is in a state.
Multigrid::Vec Multigrid::force_on(const FacetState& facet, std::int32_t node) {
  return law().force(facet, displacement_of(node));
}

/// What the hierarchy takes for the tangent of a facet that is not stuck.
const Mat& Multigrid::known_tangent(const FacetState& facet) const {
  return known_tangents_[at(base::index(facet.direction))][number_of(facet)];
}

/// Whether the robot is much wider than its feet are together.
bool Multigrid::is_wide_on_feet() const {
  const auto feet = static_cast<double>(host::total(ranks(), ground_nodes_.size()));
  return !network_.is_along_axes && static_cast<double>(network_.all_count) >
                                        kWidthMax * feet * static_cast<double>(network_.extent);
}

/// Facets, where they are few: those of a few feet. Which part of a foot presses decides how it
/// tilts, and a cluster as large as the foot cannot know.
std::vector<std::int32_t> Multigrid::nodes_alone() const {
  std::vector<std::int32_t> nodes;
  const std::size_t count = host::total(ranks(), ground_nodes_.size());
  if (!options_.is_bonded && count <= kAloneMax && kAloneShare * count <= network_.all_count &&
      !is_wide_on_feet()) {
    for (const GroundNode& ground_node : ground_nodes_) {
      if (nodes.empty() || nodes.back() != ground_node.node) {
        nodes.push_back(ground_node.node);
      }
    }
  }
  return nodes;
}

std::unique_ptr<Iteration> Multigrid::make_iteration() {
  if (precision_ == Precision::kDouble) {
    return std::make_unique<ConjugateGradients<double>>(network_, robot().material(), team_,
                                                        known_tangents_, alone_);
  }
  return std::make_unique<ConjugateGradients<float>>(network_, robot().material(), team_,
                                                     known_tangents_, alone_);
}

void Multigrid::update_iteration() {
  if (iteration_ && !is_law_new_) {
    if (host::any(ranks(), is_contact_new_)) {
      iteration_->update_contact();
      is_contact_new_ = false;
    }
    return;
  }
  std::vector<double> x = std::move(this->x());
  iteration_.reset();
  find_order(robot(), network_);
  iteration_ = make_iteration();
  is_law_new_ = false;
  is_contact_new_ = false;
  is_residual_known_ = false;
  if (!x.empty()) {
    iteration_->x() = std::move(x);
  }
  iteration_->progress = [this](int, double error) {
    error_ = error;
    if (options_.progress) {
      options_.progress(++told_count_, std::sqrt(std::max(0.0, error) / reference_));
    }
  };
}

/// What the present displacements leave unbalanced, with the contact's own tangent.
void Multigrid::compute_residual() {
  team_.share(0, network_.own_count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t node = begin; node < end; ++node) {
      iteration_->set_residual(node, load_of(node));
    }
  });
  if (reference_ > 0) {
    iteration_->subtract_product();
  }
  for (const GroundNode& ground_node : ground_nodes_) {
    const FacetState& facet = facets()[ground_node.facet];
    if (number_of(facet) != 0) {
      const Vec known = base::multiply(known_tangent(facet), displacement_of(ground_node.node));
      const Vec true_force = force_on(facet, ground_node.node);
      Vec left = iteration_->residual(at(ground_node.node));
      for (std::size_t k = 0; k < 6; ++k) {
        left[k] -= true_force[k] - known[k];
      }
      iteration_->set_residual(at(ground_node.node), left);
    }
  }
}

/// Updates the residual where only facets have changed since: x and r differ by rounding alone.
void Multigrid::update_residual() {
  for (const GroundNode& ground_node : ground_nodes_) {
    const FacetState& facet = facets()[ground_node.facet];
    if (number_of(facet) != number_of(ground_node.known)) {
      const Vec before = force_on(ground_node.known, ground_node.node);
      const Vec now = force_on(facet, ground_node.node);
      Vec left = iteration_->residual(at(ground_node.node));
      for (std::size_t k = 0; k < 6; ++k) {
        left[k] += before[k] - now[k];
      }
      iteration_->set_residual(at(ground_node.node), left);
    }
  }
}

/// What the contact's tangent has beyond what the hierarchy knows of it.
std::vector<NodeTerm> Multigrid::unsymmetric_terms() const {
  std::vector<NodeTerm> terms;
  for (const GroundNode& ground_node : ground_nodes_) {
    const FacetState& facet = facets()[ground_node.facet];
    if (ground().law == ContactLaw::kRegularised &&
        (facet.state.tilt_x != 0 || facet.state.tilt_y != 0)) {
      NodeTerm& term = terms.emplace_back();
      term = {.node = ground_node.node, .difference = law().tangent(facet)};
      base::add_to(term.difference, scaled(known_tangent(facet), -1));
    }
  }
  return terms;
}

/// Takes up changed facets. What has not changed since the last solution goes on from there.
LinearOutcome Multigrid::begin() {
  is_stale_ = host::any(ranks(), is_stale_);
  if (!is_stale_) {
    return LinearOutcome::kSolved;
  }
  if (precision_ == Precision::kSingle && is_too_slender()) {
    return LinearOutcome::kTooSlow;
  }
  update_iteration();
  if (iteration_->is_singular()) {
    is_residual_known_ = false;
    return LinearOutcome::kSingular;
  }
  if (precision_ == Precision::kSingle && iteration_->is_too_slender()) {
    return LinearOutcome::kTooSlow;
  }
  if (is_residual_known_) {
    update_residual();
  } else {
    compute_residual();
  }
  is_residual_known_ = true;
  for (GroundNode& ground_node : ground_nodes_) {
    ground_node.known = facets()[ground_node.facet];
  }
  error_ = iteration_->begin();
  if (reference_ == 0) {
    reference_ = error_;
  }
  is_stale_ = false;
  return LinearOutcome::kSolved;
}

/// Whether bending is that of chains: the network has few nodes, and these few neighbours. A single
/// beam may then have a large part of the whole error's energy. Of cubes the ground that they are
/// stuck to counts as one.
bool Multigrid::is_thin() const {
  if (network_.all_count > kThinCountMax) {
    return false;
  }
  const auto stuck_count = static_cast<std::size_t>(
      network_.is_along_axes ? std::ranges::count(network_.ground_beams, 0, &GroundBeam::contact)
                             : 0);
  return static_cast<double>(host::total(ranks(), network_.beams.end_count + stuck_count)) <=
         kThinEndCount * static_cast<double>(network_.all_count);
}

LinearOutcome Multigrid::solve(double tolerance) {
  is_stale_ = host::any(ranks(), is_stale_);
  solve_count_ += is_stale_ ? 1 : 0;
  return improve({.tolerance = tolerance});
}

/// A step is the best one along M^-1 r as long as K is symmetric.
LinearOutcome Multigrid::approach() {
  constexpr double kRoughly = 0.1;
  if (network_.all_count == 0 || !host::all(ranks(), unsymmetric_terms().empty())) {
    return solve(kRoughly);
  }
  is_stale_ = host::any(ranks(), is_stale_);
  solve_count_ += is_stale_ ? 1 : 0;
  const LinearOutcome beginning = begin();
  if (beginning != LinearOutcome::kSolved) {
    return beginning;
  }
  is_stale_ = true;
  if (!iteration_->step()) {
    is_residual_known_ = false;
    return LinearOutcome::kTooSlow;
  }
  ++iteration_count_;
  return LinearOutcome::kSolved;
}

/// Goes on from the present displacements.
LinearOutcome Multigrid::improve(const Target& target) {
  if (network_.all_count == 0) {
    return LinearOutcome::kSolved;
  }
  const LinearOutcome beginning = begin();
  if (beginning != LinearOutcome::kSolved) {
    return beginning;
  }
  const int before = iteration_->iteration_count();
  energy_error_ = std::min(target.tolerance * std::sqrt(reference_), target.error_max);
  const Iteration::Goal goal = {.error = energy_error_ * energy_error_,
                                .iteration_count_min = target.iteration_count_min,
                                .iteration_count_max = kIterationMax};
  const std::vector<NodeTerm> terms = unsymmetric_terms();
  const auto end = host::all(ranks(), terms.empty()) ? iteration_->run(goal)
                                                     : iteration_->run_unsymmetric(goal, terms);
  last_count_ = iteration_->iteration_count() - before;
  iteration_count_ += last_count_;
  if (end == Iteration::End::kConverged) {
    return LinearOutcome::kSolved;
  }
  iteration_->x().assign(iteration_->x().size(), 0);  // Nothing to go on from.
  is_residual_known_ = false;
  is_stale_ = true;
  return LinearOutcome::kTooSlow;
}

bool Multigrid::refine(Solution& solution) {
  solution.gamma = ground().gamma;
  // Where convergence is slow r . M^-1 r misses more of the error.
  const double pace = std::min(1.0, kBriskIterations / last_count_);
  const double share = precision_ == Precision::kDouble ? kSlenderShare : 1;
  Target target = {.tolerance = options_.tolerance * share * pace * pace * pace};
  // One iteration at least: else the two answers are the same, and say nothing about the error.
  target.iteration_count_min = 1;
  if (is_thin()) {
    target.error_max = kThinError * options_.tolerance / model::load_ratio_per_energy_norm(robot());
  }
  if (iteration_) {
    iteration_->mark();
  }
  if (improve(target) != LinearOutcome::kSolved) {
    return false;
  }
  solution.energy_error = energy_error_;
  if (has_weak_springs()) {
    const double left = take_back_weak_springs();
    solution.gamma = left == 0 ? 0 : solution.gamma;
    solution.energy_error += left;
  }
  return true;
}

/// Adds what weak springs do at the present displacements to the residual, less what was `taken` of
/// it before. Returns r . M^-1 r.
double Multigrid::take_back_weak_forces(std::vector<Vec>& taken) {
  const FacetLaw<double> exact = law().with_gamma(0);
  for (std::size_t i = 0; i < ground_nodes_.size(); ++i) {
    const GroundNode& ground_node = ground_nodes_[i];
    const FacetState& facet = facets()[ground_node.facet];
    const Vec u = displacement_of(ground_node.node);
    Vec weak = law().force(facet, u);
    const Vec rest = exact.force(facet, u);
    Vec left = iteration_->residual(at(ground_node.node));
    for (std::size_t k = 0; k < 6; ++k) {
      weak[k] -= rest[k];
      left[k] += weak[k] - taken[i][k];
    }
    iteration_->set_residual(at(ground_node.node), left);
    taken[i] = weak;
  }
  return iteration_->begin();
}

/// The iteration's K has the weak springs W, and W <= K. So K u_next = f + W u leads to the
/// solution without them wherever there is one. Returns 0; or, if facets would then be in other
/// states, how far that is away in the energy norm; infinity if it is not reached. marked() is then
/// still the solution with them.
double Multigrid::take_back_weak_springs() {
  constexpr double kNotReached = std::numeric_limits<double>::infinity();
  const double error_max = energy_error_ * energy_error_;
  const Iteration::Goal goal = {
      .error = error_max, .iteration_count_min = 0, .iteration_count_max = kIterationMax};
  std::vector<Vec> taken(ground_nodes_.size());
  double first = 0;
  double before = kNotReached;
  bool is_over = false;
  for (int step = 0; step < kTakeBackMax; ++step) {
    const double error = take_back_weak_forces(taken);
    is_over = error <= error_max;
    if (is_over || !(error < kTakeBackPace * kTakeBackPace * before)) {
      break;
    }
    if (step == 0) {
      first = std::sqrt(error);
      iteration_->mark();
    }
    if (iteration_->run(goal) != Iteration::End::kConverged) {
      break;
    }
    before = error;
  }
  is_residual_known_ = false;
  is_stale_ = true;
  const FacetLaw<double> exact = law().with_gamma(0);
  const bool is_consistent = std::ranges::all_of(ground_nodes_, [&](const GroundNode& node) {
    const FacetState& facet = facets()[node.facet];
    return exact.state_at(facet, displacement_of(node.node)) == facet.state;
  });
  if (!is_over) {
    return kNotReached;
  }
  return host::all(ranks(), is_consistent) ? 0 : energy_error_ + first / (1 - kTakeBackPace);
}

/// The second answer is the one that refine() began with. All that is not needed any more goes
/// before memory is taken for it; who asks further all the same begins anew.
void Multigrid::hand_over(Solution& solution, Further further) {
  std::vector<double> first;
  std::vector<double> last;
  if (iteration_ && further == Further::kNothing) {
    iteration_->retire();
    first = iteration_->marked();
    last = std::move(iteration_->x());
    iteration_.reset();
    reference_ = 0;
    is_law_new_ = true;
    is_residual_known_ = false;
    is_stale_ = true;
  } else if (iteration_) {
    iteration_->rest();
    is_stale_ = true;
    first = iteration_->marked();
  }
  solution.alternative = by_module(first);
  first = std::vector<double>();
  solution.displacement = by_module(iteration_ ? x() : last);
}

std::vector<double> Multigrid::facet_errors() const {
  std::vector<double> errors(facets().size());
  for (std::size_t i = 0; i < errors.size() && iteration_; ++i) {
    const Vec correction = iteration_->correction(at(ground_nodes_[ground_node_of_facet_[i]].node));
    const Vec force = law().trial_force(facets()[i], correction);
    errors[i] =
        std::abs(force[2]) + std::max(std::abs(force[3]), std::abs(force[4])) / ground().half_width;
  }
  const double pace = std::max(1.0, last_count_ / kBriskIterations);
  const double largest = errors.empty() ? 0 : *std::ranges::max_element(errors);
  const double common = kCorrectionShare * host::max(ranks(), largest);
  for (double& error : errors) {
    error = kCorrectionFactor * pace * std::max(error, common);
  }
  return errors;
}

double Multigrid::energy_error() const { return std::sqrt(std::max(0.0, error_)); }

LinearReport Multigrid::report() const {
  return {.method = Method::kMultigrid,
          .precision = precision_,
          .solve_count = solve_count_,
          .iteration_count = iteration_count_};
}

std::vector<base::Vec6<double>> Multigrid::displacement() { return by_module(x()); }

/// Facets are the nodes' alone.
std::vector<base::Vec6<double>> Multigrid::facet_displacement() {
  std::vector<Vec> by_facet;
  by_facet.reserve(facets().size());
  for (std::size_t i = 0; i < facets().size(); ++i) {
    by_facet.push_back(x().empty() ? Vec{}
                                   : displacement_of(ground_nodes_[ground_node_of_facet_[i]].node));
  }
  return by_facet;
}

/// Turns nodes' displacements into those of all modules.
std::vector<base::Vec6<double>> Multigrid::by_module(std::vector<double>& x) {
  std::vector<Vec> all(robot().modules().size());
  if (!x.empty()) {
    node_copies_->update(x.data(), 6 * sizeof(double));
    team_.share(0, network_.node_count, [&](std::size_t begin, std::size_t end) {
      for (std::size_t node = begin; node < end; ++node) {
        std::copy_n(x.begin() + static_cast<std::ptrdiff_t>(6 * node), 6,
                    all[at(network_.module[node])].begin());
      }
    });
  }
  recover(robot(), network_, team_, loads(), condensed_, all, *module_copies_);
  return all;
}

}  // namespace holdfast::solver
