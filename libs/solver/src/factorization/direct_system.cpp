// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "factorization/direct_system.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "factorization/beam_forces.hpp"
#include "factorization/block_kernels.hpp"
#include "factorization/precise_refinement.hpp"
#include "factorization/stressed_beams.hpp"
#include "holdfast/base/algebra.hpp"
#include "holdfast/base/check.hpp"

namespace holdfast::solver {
namespace {

using base::at;

using base::Mat6;
using base::Vec6;
using mechanics::ContactLaw;
using mechanics::ContactState;

/// The first step removes most of the rounding error, the second measures what is left.
constexpr int kRefinementCount = 2;

/// If the last step still moves something by more than this share, digits are missing.
constexpr double kRefinedShare = 1e-3;

/// Weak springs are taken back until a step moves nothing by more than this share, or by what
/// rounding does.
constexpr double kTakenBackShare = 1e-12;
constexpr double kTakenBackRounding = 1e-9;

/// What the factorization takes: for a block, upper and lower; for a node, the diagonal and its
/// inverse; for an edge, its own block.
constexpr std::size_t kBlockBytes = 2 * sizeof(Mat6<double>) + 24;
constexpr std::size_t kNodeBytes = 3 * sizeof(Mat6<double>) + 120;
constexpr std::size_t kEdgeBytes = sizeof(Mat6<double>) + 64;
constexpr std::size_t kNoLimit = std::numeric_limits<std::size_t>::max();

/// How many blocks may fill in.
std::size_t block_count_max(const EquilibriumOptions& options, std::size_t node_count,
                            std::size_t edge_count) {
  const std::size_t always = kNodeBytes * node_count + kEdgeBytes * edge_count;
  const std::size_t memory = options.memory_bytes_max;
  const std::size_t affordable = memory > always ? (memory - always) / kBlockBytes : 0;
  const bool is_limited = options.fill_max < kNoLimit / (node_count + 1);
  return is_limited ? std::min(affordable, options.fill_max * node_count) : affordable;
}

/// How far the two answers are apart, as a share of the largest displacement; 0 if there is none.
double change_share(const Solution& solution) {
  double largest = 0;
  double change = 0;
  for (std::size_t i = 0; i < solution.displacement.size(); ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      const double u = solution.displacement[i][k];
      largest = std::max(largest, std::abs(u));
      change = std::max(change, std::abs(u - solution.alternative[i][k]));
    }
  }
  return change > 0 ? change / largest : 0;
}

/// Whether the last refinement had next to nothing to correct. On a robot so slender that bending
/// drowns in double precision's rounding, each finds something else.
bool is_refined(const Solution& solution) { return change_share(solution) <= kRefinedShare; }

}  // namespace

std::unique_ptr<DirectSystem> DirectSystem::make(const model::Robot& robot,
                                                 const EquilibriumOptions& options,
                                                 std::size_t product_count_max) {
  std::unique_ptr<DirectSystem> system(new DirectSystem(robot, options));
  if (system->lu_->is_too_large() || system->lu_->factor_product_count() > product_count_max) {
    return nullptr;
  }
  system->assemble();
  return system;
}

DirectSystem::DirectSystem(const model::Robot& robot, const EquilibriumOptions& options)
    : LinearSystem(robot),
      is_bonded_(options.is_bonded),
      is_precise_(options.is_precise),
      thread_count_(options.thread_count),
      node_of_module_(robot.modules().size(), -1) {
  std::int32_t next = 0;
  for (std::size_t i = 0; i < node_of_module_.size(); ++i) {
    if (robot.modules()[i].support != model::Support::kFixed) {
      node_of_module_[i] = next++;
    }
  }
  diagonal_.resize(at(next));
  order(options);
}

std::int32_t DirectSystem::node_of(std::int32_t module) const {
  return node_of_module_[at(module)];
}

/// Finds the order of elimination and what fills in.
void DirectSystem::order(const EquilibriumOptions& options) {
  std::vector<Edge> edges;
  edges.reserve(robot().connections().size());
  for (const model::Connection& connection : robot().connections()) {
    const Edge edge{node_of(connection.a), node_of(connection.b)};
    if (edge.a >= 0 && edge.b >= 0) {
      edges.push_back(edge);
    }
  }
  lu_.emplace(diagonal_.size(), edges, block_count_max(options, diagonal_.size(), edges.size()),
              Symmetry::kSymmetric);
}

/// Assembles everything but the contact.
void DirectSystem::assemble() {
  diagonal_ = set_connections();
  for (std::size_t node = 0; node < diagonal_.size(); ++node) {
    lu_->set_diagonal(node, diagonal_[node]);
  }
}

/// K12 of every beam off the diagonal; returns K11 of all their ends, which stand on it (Eqs. 3,
/// 5).
std::vector<Mat6<double>> DirectSystem::set_connections() {
  std::array<Mat6<double>, base::Lattice::kDirectionCountMax> k11;
  std::array<Mat6<double>, base::Lattice::kDirectionCountMax> k12;
  for (const base::Direction direction : base::directions(robot().lattice())) {
    const auto i = static_cast<std::size_t>(base::index(direction));
    k11[i] = beam().block_11(direction);
    k12[i] = beam().block_12(direction);
  }
  std::vector<Mat6<double>> diagonal(lu_->node_count());
  std::size_t edge = 0;
  for (const model::Connection connection : robot().connections()) {
    const std::int32_t a = node_of(connection.a);
    const std::int32_t b = node_of(connection.b);
    const auto direction = static_cast<std::size_t>(base::index(connection.direction));
    const auto opposite =
        static_cast<std::size_t>(base::index(base::opposite(connection.direction)));
    if (a >= 0) {
      base::add_to(diagonal[at(a)], k11[direction]);
    }
    if (b >= 0) {
      base::add_to(diagonal[at(b)], k11[opposite]);
    }
    if (a >= 0 && b >= 0) {
      lu_->set_edge(edge++, k12[direction]);
    }
  }
  return diagonal;
}

void DirectSystem::take_law() {
  if (std::ranges::all_of(facets(), [&](const FacetState& facet) { return is_symmetric(facet); })) {
    lu_->set_symmetry(Symmetry::kSymmetric);
  }
  for (std::size_t i = 0; i < facets().size(); i = first_facet_after(i)) {
    take_facet(i);
  }
}

/// Whether the derivative of the facet's force is symmetric: not where it tilts and its torque
/// follows the force.
bool DirectSystem::is_symmetric(const FacetState& facet) const {
  const bool tilts = facet.state.tilt_x != 0 || facet.state.tilt_y != 0;
  return !tilts || ground().law == ContactLaw::kUnilateral;
}

/// The first facet of the next module.
std::size_t DirectSystem::first_facet_after(std::size_t facet) const {
  const std::size_t module = facets()[facet].module;
  while (facet < facets().size() && facets()[facet].module == module) {
    ++facet;
  }
  return facet;
}

void DirectSystem::take_facet(std::size_t facet) {
  const std::size_t module = facets()[facet].module;
  while (facet > 0 && facets()[facet - 1].module == module) {
    --facet;
  }
  for (std::size_t i = facet; i < first_facet_after(facet); ++i) {
    if (!is_symmetric(facets()[i])) {
      lu_->set_symmetry(Symmetry::kNone);
    }
  }
  const std::size_t node = at(node_of_module_[module]);
  Mat6<double> block = diagonal_[node];
  for (std::size_t i = facet; i < first_facet_after(facet); ++i) {
    base::add_to(block, law().tangent(facets()[i]));
  }
  lu_->set_diagonal(node, block);
}

/// Turns one vector per node into one per module; fixed modules get zero.
std::vector<Vec6<double>> DirectSystem::by_module(const std::vector<Vec>& by_node) const {
  std::vector<Vec> vectors(node_of_module_.size(), Vec{});
  for (std::size_t i = 0; i < vectors.size(); ++i) {
    if (node_of_module_[i] >= 0) {
      vectors[i] = by_node[at(node_of_module_[i])];
    }
  }
  return vectors;
}

/// Turns loads by module into loads by node; those of fixed modules mean nothing.
template <class Load>
std::vector<Vec6<double>> DirectSystem::by_node(const Load& load) const {
  std::vector<Vec> vectors(diagonal_.size());
  for (std::size_t i = 0; i < node_of_module_.size(); ++i) {
    if (node_of_module_[i] >= 0) {
      vectors[at(node_of_module_[i])] = load[i];
    }
  }
  return vectors;
}

LinearOutcome DirectSystem::solve(double /*tolerance*/) {
  ++solve_count_;
  if (!lu_->factor(thread_count_)) {
    return LinearOutcome::kSingular;
  }
  x_ = by_node(loads());
  lu_->solve(x_);
  return LinearOutcome::kSolved;
}

std::vector<Vec6<double>> DirectSystem::displacement() { return by_module(x_); }

/// Fixed modules have no facets.
std::vector<Vec6<double>> DirectSystem::facet_displacement() {
  std::vector<Vec> by_facet;
  by_facet.reserve(facets().size());
  for (const FacetState& facet : facets()) {
    by_facet.push_back(x_[at(node_of_module_[facet.module])]);
  }
  return by_facet;
}

std::optional<std::vector<std::vector<Vec6<double>>>> DirectSystem::solve_each(
    std::span<const model::Loads> loads, double /*tolerance*/) {
  if (!lu_->factor(thread_count_)) {
    return std::nullopt;
  }
  std::vector<std::vector<Vec>> columns;
  for (const model::Loads& load : loads) {
    columns.push_back(by_node(load));
  }
  lu_->solve_each(columns);
  for (std::vector<Vec>& column : columns) {
    column = by_module(column);
  }
  return columns;
}

std::optional<bool> DirectSystem::is_definite(StressedBeams& beams, double factor) {
  if (factor == 0) {
    return lu_->factor(thread_count_) && lu_->is_positive_definite();
  }
  BlockLu sum = *lu_;
  add_stress(beams, factor, sum);
  return sum.factor(thread_count_) && sum.is_positive_definite();
}

/// Makes K + factor K_G of K.
void DirectSystem::add_stress(StressedBeams& beams, double factor, BlockLu& lu) const {
  std::vector<Mat6<double>> diagonal = diagonal_;
  const auto add = [&](std::int32_t node, const Mat6<double>& block) {
    if (node >= 0) {
      base::add_to(diagonal[at(node)], scaled(block, factor));
    }
  };
  std::size_t edge = 0;
  for (const model::Connection connection : robot().connections()) {
    const std::int32_t a = node_of(connection.a);
    const std::int32_t b = node_of(connection.b);
    const mechanics::EndTangent blocks = beams.blocks(connection);
    add(a, blocks.pp);
    add(b, blocks.qq);
    if (a >= 0 && b >= 0) {
      Mat6<double> between = beam().block_12(connection.direction);
      base::add_to(between, scaled(blocks.pq, factor));
      lu.set_edge(edge++, between);
    }
  }
  for (std::size_t i = 0; i < facets().size(); ++i) {
    const std::int32_t node = node_of_module_[facets()[i].module];
    base::add_to(diagonal[at(node)], law().tangent(facets()[i]));
    add(node, beams.block(i));
  }
  for (std::size_t node = 0; node < diagonal.size(); ++node) {
    lu.set_diagonal(node, diagonal[node]);
  }
}

/// The displacements under loads, both by module, with the factors that are there.
std::vector<Vec6<double>> DirectSystem::solve_for(const std::vector<Vec>& load) const {
  std::vector<Vec> x = by_node(load);
  lu_->solve(x);
  return by_module(x);
}

bool DirectSystem::refine(Solution& solution) {
  solution.gamma = ground().gamma;
  solution.displacement = displacement();
  for (int step = 0; step < kRefinementCount; ++step) {
    refine_once(solution, law());
  }
  const bool is_enough = is_refined(solution);
  const bool is_any_open_but_held = std::ranges::any_of(
      facets(), [](const FacetState& facet) { return !facet.state.pressed && facet.is_held; });
  if (has_weak_springs() && (is_precise_ || !is_enough) && !is_any_open_but_held &&
      refine_without_weak_springs(solution)) {
    return true;
  }
  if (has_weak_springs() && is_enough) {
    take_back_weak_springs(solution);
    return true;
  }
  if (is_enough && !is_precise_) {
    return true;
  }
  return refine_precisely(solution);
}

/// Solves for the residual by a law and adds the correction.
void DirectSystem::refine_once(Solution& solution, const FacetLaw<double>& law) const {
  std::vector<Vec> residual = beam_forces(robot(), beam(), solution.displacement);
  for (const FacetState& facet : facets()) {
    base::add_to(residual[facet.module], law.force(facet, solution.displacement[facet.module]));
  }
  for (std::size_t i = 0; i < residual.size(); ++i) {
    residual[i] = sum(loads()[i], -1, residual[i]);
  }
  solution.alternative = solution.displacement;
  solution.displacement = sum(std::move(solution.displacement), 1, solve_for(residual));
}

/// The factors are those of K with the weak springs W, and W <= K. So steps by the residual of the
/// robot without them, K u_next = f + W u, lead to its solution wherever it has one. If that is not
/// reached, or facets would then be in other states, it is the second answer: what the weak springs
/// do is then known about, but not left out, and in the error's energy.
void DirectSystem::take_back_weak_springs(Solution& solution) const {
  const FacetLaw<double> exact = law().with_gamma(0);
  Solution next;
  next.displacement = solution.displacement;
  double before = std::numeric_limits<double>::infinity();
  bool is_over = false;
  for (int step = 0; step < kTakeBackMax && !is_over; ++step) {
    refine_once(next, exact);
    const double change = change_share(next);
    const bool is_shorter = change < kTakeBackPace * before;
    is_over = change <= (is_shorter ? kTakenBackShare : kTakenBackRounding);
    if (!is_shorter) {
      break;
    }
    before = change;
  }
  const bool is_consistent = std::ranges::all_of(facets(), [&](const FacetState& facet) {
    return exact.state_at(facet, next.displacement[facet.module]) == facet.state;
  });
  if (is_over && is_consistent) {
    // What rounding leaves the first refinement knows better than the last, short step.
    const bool is_rounding = change_share(next) <= change_share(solution);
    const std::vector<Vec> rounding = sum(solution.alternative, -1, solution.displacement);
    solution.alternative =
        is_rounding ? sum(next.displacement, 1, rounding) : std::move(next.alternative);
    solution.displacement = std::move(next.displacement);
    solution.gamma = 0;
    return;
  }
  solution.energy_error = std::numeric_limits<double>::infinity();
  if (is_over) {
    const std::vector<Vec> change = sum(next.displacement, -1, solution.displacement);
    solution.energy_error =
        std::sqrt(std::max(0.0, dot_all(beam_forces(robot(), beam(), change), change)));
  }
  solution.alternative = std::move(next.displacement);
}

/// Returns false if that does not settle, or the facets' states are then other ones.
bool DirectSystem::refine_precisely(Solution& solution) {
  PreciseRefinement refinement(*this);
  const bool is_found = refinement.run(solution.displacement,
                                       [&](std::vector<Vec>& load) { load = solve_for(load); });
  const std::vector<ContactState> states = refinement.states();
  const bool is_consistent =
      is_bonded_ || std::ranges::equal(facets(), states, {}, &FacetState::state);
  if (!is_found || !is_consistent) {
    return false;
  }
  solution.displacement = refinement.high();
  solution.displacement_low = refinement.low();
  solution.alternative = solution.displacement;
  return true;
}

/// The weak springs keep the matrix regular until the states are found; a robot that stands does
/// without them then, unless feet are yet to be freed. Leaves everything as it was if this one does
/// not.
bool DirectSystem::refine_without_weak_springs(Solution& solution) {
  const double gamma = ground().gamma;
  const std::vector<Vec> displacement = solution.displacement;
  set_gamma(0);
  if (lu_->factor(thread_count_) && refine_precisely(solution)) {
    solution.gamma = 0;
    return true;
  }
  solution.displacement = displacement;
  set_gamma(gamma);
  HOLDFAST_CHECK(lu_->factor(thread_count_));  // As it was before.
  return false;
}

}  // namespace holdfast::solver
