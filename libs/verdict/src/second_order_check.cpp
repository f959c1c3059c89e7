// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "second_order_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "holdfast/host/team.hpp"
#include "holdfast/model/large_beams.hpp"
#include "holdfast/model/lattice_beam.hpp"
#include "stability.hpp"

namespace holdfast::verdict {
namespace {

using base::Vec6;
using solver::BucklingAnswer;
using solver::SecondOrderWish;
using Displacements = std::vector<Vec6<double>>;

/// The largest load ratio may change by so much of it, or by so much.
constexpr double kRatioShare = 0.02;
constexpr double kRatioChange = 0.002;

/// What is added to second order grows by 1 / (1 - 1 / factor), at most to 1 / kShareLeft.
constexpr double kShareLeft = 0.05;
constexpr double kNearlyOne = 1.05;

/// The length of a vector, the same everywhere, which std::hypot() is not.
double norm_of(double x, double y, double z = 0) { return std::sqrt(x * x + y * y + z * z); }

double growth(const SecondOrder& second) {
  if (second.answer == BucklingAnswer::kNone) {
    return 1;
  }
  return second.factor > kNearlyOne ? 1 / (1 - 1 / second.factor) : 1 / kShareLeft;
}

/// The beams of a robot, large and small, by direction.
class Beams {
 public:
  explicit Beams(const model::Robot& robot)
      : linear_(model::beam_section(robot.material()), robot.lattice()),
        facet_(solver::facet_law(robot, linear_,
                                 {.law = mechanics::ContactLaw::kUnilateral, .gamma = 0})),
        large_(linear_, robot.lattice()) {}

  // facet_ keeps a reference to linear_.
  Beams(const Beams&) = delete;
  Beams& operator=(const Beams&) = delete;

  Vec6<double> first(base::Direction direction, const Vec6<double>& p,
                     const Vec6<double>& q) const {
    return linear_.middle_force(direction, p, q);
  }

  /// The force in the middle of second order, by statics: of u2, and of u1 to second order.
  Vec6<double> second(base::Direction direction, const Vec6<double>& p1, const Vec6<double>& q1,
                      const Vec6<double>& p2, const Vec6<double>& q2) const {
    const base::Direction back = base::opposite(direction);
    const Vec6<double> second_on_q = base::sum_of(linear_.end_force(back, q2, p2), 1.0,
                                                  large_[direction].second_order_forces(p1, q1).q);
    return large_[direction].second_order_middle_force(p1, q1, linear_.end_force(back, q1, p1),
                                                       second_on_q);
  }

  /// The moment of a facet that sticks as a share of what its pressure holds; infinite without
  /// pressure.
  double reserve(const model::Facet& facet, const Vec6<double>& u1, const Vec6<double>& u2,
                 double factor) const {
    const auto trial = [&](const Vec6<double>& u) {
      return mechanics::trial_force(facet_.ground(facet.direction),
                                    linear_.to_local(facet.direction, u));
    };
    Vec6<double> stress = trial(u1);
    base::add_times(stress, factor, trial(u2));
    base::add_times(stress, factor, large_[facet.direction].second_order_stress(u1, {}));
    const double moment = std::max(std::abs(stress[3]), std::abs(stress[4]));
    const double held = -stress[2] * facet_.ground(facet.direction).half_width;
    return held > 0 ? moment / held : std::numeric_limits<double>::infinity();
  }

  /// The strain at the edge of a facet under a stress.
  double edge_strain(base::Direction direction, const Vec6<double>& stress,
                     const model::Material& material) const {
    const Vec6<double>& k = large_[direction].stiffness();
    return (std::abs(stress[2] / k[2]) +
            material.facet_mm / 2 * norm_of(stress[3] / k[3], stress[4] / k[4])) /
           large_[direction].length();
  }

 private:
  model::LatticeBeam<double> linear_;
  solver::FacetLaw<double> facet_;
  model::LargeBeams large_;
};

/// The largest numbers of some connections.
struct Largest {
  double first = -std::numeric_limits<double>::infinity();   ///< Load ratio of first order,
  double second = -std::numeric_limits<double>::infinity();  ///< and of second.
  double strain = 0;
};

/// The larger number, or what is none.
double larger(double a, double b) { return std::isnan(a) || a > b ? a : b; }

Largest largest_of_all(const model::Robot& robot, const Beams& beams, const Displacements& u1,
                       const Displacements& u2, double factor, int thread_count) {
  const auto connections = robot.connections();
  host::Team team(thread_count, connections.size());
  std::vector<Largest> chunks;
  team.map(connections.size(), chunks, [&](std::size_t begin, std::size_t end) {
    Largest largest;
    auto connection = connections.from(begin);
    for (std::size_t i = begin; i < end; ++i, ++connection) {
      const model::Connection pair = *connection;
      const std::size_t p = base::at(pair.a);
      const std::size_t q = base::at(pair.b);
      const Vec6<double> stress = beams.first(pair.direction, u1[p], u1[q]);
      largest.first = larger(largest.first, model::load_ratio(robot.connector(pair), stress).ratio);
      largest.strain =
          larger(largest.strain, beams.edge_strain(pair.direction, stress, robot.material()));
      if (!u2.empty()) {
        Vec6<double> both = stress;
        base::add_times(both, factor, beams.second(pair.direction, u1[p], u1[q], u2[p], u2[q]));
        largest.second =
            larger(largest.second, model::load_ratio(robot.connector(pair), both).ratio);
      }
    }
    return largest;
  });
  Largest all;
  for (const Largest& chunk : chunks) {
    all = {.first = larger(all.first, chunk.first),
           .second = larger(all.second, chunk.second),
           .strain = larger(all.strain, chunk.strain)};
  }
  return all;
}

std::optional<BucklingMode> largest_motion(const model::Robot& robot, const Displacements& mode) {
  std::optional<BucklingMode> largest;
  double length = 0;
  for (std::size_t i = 0; i < mode.size(); ++i) {
    const double way = norm_of(mode[i][0], mode[i][1], mode[i][2]);
    if (way > length * (1 + kLoadRatioTie)) {
      length = way;
      largest = {.cell = robot.modules()[i].cell,
                 .direction = {mode[i][0] / way, mode[i][1] / way, mode[i][2] / way}};
    }
  }
  if (largest) {
    auto& direction = largest->direction;
    const double most = *std::ranges::max_element(
        direction, {}, [](double component) { return std::abs(component); });
    for (double& component : direction) {
      component = most < 0 ? -component : component;
    }
  }
  return largest;
}

/// Facets that do not stick once more by the exact law; none where that takes long, or all stick.
std::optional<solver::Equilibrium> exact_equilibrium(const Assessment& assessment,
                                                     solver::EquilibriumSolver& solver,
                                                     double gamma) {
  const solver::Equilibrium& found = assessment.equilibrium;
  if (solver::are_all_stuck(found) || !found.slip.empty() ||
      found.law == mechanics::ContactLaw::kUnilateral ||
      solver.prepare(mechanics::ContactLaw::kUnilateral) == solver::Method::kMultigrid) {
    return std::nullopt;
  }
  auto exact = solver.solve({.law = mechanics::ContactLaw::kUnilateral, .gamma = gamma});
  return exact.outcome == solver::Outcome::kSettled ? std::optional(std::move(exact))
                                                    : std::nullopt;
}

void take_facets(const model::Robot& robot, const Beams& beams,
                 const solver::Equilibrium& equilibrium, const Displacements& u2, bool is_bonded,
                 SecondOrder& second) {
  for (std::size_t i = 0; i < robot.facets().size() && !is_bonded; ++i) {
    const model::Facet& facet = robot.facets()[i];
    const std::size_t module = base::at(facet.module);
    if (!facet.is_bonded() && equilibrium.contact[i] == mechanics::kStuck) {
      second.facet_reserve_max =
          larger(beams.reserve(facet, equilibrium.displacement[module], u2[module], growth(second)),
                 second.facet_reserve_max);
    }
  }
}

void take_motion(const Displacements& u1, SecondOrder& second) {
  for (const Vec6<double>& u : u1) {
    second.displacement_max_mm = std::max(second.displacement_max_mm, norm_of(u[0], u[1], u[2]));
    second.rotation_max_rad = std::max(second.rotation_max_rad, norm_of(u[3], u[4], u[5]));
  }
}

bool has_factor_below(const SecondOrder& second, double bound) {
  return second.buckling_factor().value_or(bound) < bound;
}

Trust trust_in(const SecondOrder& second, double load_ratio_first) {
  const bool is_soft =
      second.answer == BucklingAnswer::kNoStiffness || has_factor_below(second, kTrustedFactor);
  const double change = second.load_ratio_max.value_or(load_ratio_first) - load_ratio_first;
  const double allowed = std::max(kRatioChange, kRatioShare * load_ratio_first);
  const bool is_near = !(std::abs(change) > allowed) || !second.load_ratio_max;
  if (is_soft || !is_near || std::isnan(change) || !(second.facet_reserve_max <= 1) ||
      second.leans_out) {
    return Trust::kNotTrusted;
  }
  return second.answer == BucklingAnswer::kAtMost ? Trust::kNotCertain : Trust::kTrusted;
}

/// Robots whose column_factor() is below this are slender.
constexpr double kSlenderFactor = 100;

/// The factor of all loads at which a column buckles that has a robot's height and as many modules
/// in each layer as it has on average [Greenhill 1881]; an estimate, as no robot is one. Payloads
/// count as weight.
double column_factor(const model::Robot& robot) {
  constexpr double kGreenhill = 7.837347;
  const auto [low, high] =
      std::ranges::minmax(robot.modules(), {}, [](const model::Module& one) { return one.cell.z; });
  double force = 0;
  for (std::size_t i = 0; i < robot.modules().size(); ++i) {
    const base::Vec6<double> load = robot.loads()[i];
    force += norm_of(load[0], load[1], load[2]);
  }
  const double layers = static_cast<double>(high.cell.z - low.cell.z) + 1;
  const double width = static_cast<double>(robot.modules().size()) / layers;
  const model::Material& material = robot.material();
  const double height = base::step_length(robot.lattice(), base::down(robot.lattice()));
  const double area = material.pitch_mm * material.pitch_mm / (height * height);
  // E I / (q l^3) of a square of `width` modules in each layer, whose weights are q l in all.
  return kGreenhill * material.elastic_modulus_mpa * width * width * area / 12 /
         (force * layers * layers);
}

}  // namespace

SecondOrderWish second_order_wish(const model::Robot& robot, SecondOrderWish asked) {
  if (robot.ranks().is_shared()) {
    return SecondOrderWish::kNothing;
  }
  const bool is_due = asked != SecondOrderWish::kCheck || robot.is_modulus_stated() ||
                      column_factor(robot) < kSlenderFactor;
  return is_due ? asked : SecondOrderWish::kBesideFactors;
}

SecondOrder check_second_order(const Situation& here, solver::EquilibriumSolver& solver,
                               double gamma, const solver::EquilibriumOptions& options,
                               const Assessment& assessment) {
  const model::Robot& robot = here.robot;
  const auto exact = exact_equilibrium(assessment, solver, gamma);
  const solver::Equilibrium& equilibrium = exact ? *exact : assessment.equilibrium;
  solver::SecondOrder found = solver.find_second_order(
      equilibrium, {.factor_max = kTrustedFactor,
                    .is_factor_wanted = options.second_order == solver::SecondOrderWish::kFactor,
                    .thread_count = options.thread_count});
  SecondOrder second{.answer = found.buckling.answer,
                     .factor = found.buckling.factor,
                     .mode = largest_motion(robot, found.buckling.mode),
                     .is_modulus_stated = robot.is_modulus_stated(),
                     .elastic_modulus_mpa = robot.material().elastic_modulus_mpa};
  const Beams beams(robot);
  const Displacements& u1 = equilibrium.displacement;
  const Displacements& u2 = found.displacement;
  take_motion(u1, second);
  const Largest largest =
      largest_of_all(robot, beams, u1, u2, growth(second), options.thread_count);
  second.edge_strain_max = largest.strain;
  if (!u2.empty()) {
    if (here.has_connections) {
      second.load_ratio_max = largest.second;
    }
    take_facets(robot, beams, equilibrium, u2, options.is_bonded, second);
    Displacements both = u1;
    for (std::size_t i = 0; i < both.size(); ++i) {
      base::add_times(both[i], growth(second), u2[i]);
    }
    const auto lean = find_lean(robot, assessment, both);
    second.leans_out = lean && lean->margin_mm <= 0;
  }
  second.trust = trust_in(second, here.has_connections ? largest.first : 0);
  return second;
}

std::optional<Reason> second_order_doubt(const Assessment& assessment) {
  const auto& second = assessment.second_order;
  if (!second || second->trust != Trust::kNotTrusted || !second->is_modulus_stated) {
    return std::nullopt;
  }
  const double ratio = assessment.load_ratio_max.value_or(0);
  const double bent = second->load_ratio_max.value_or(ratio);
  const double factor = second->buckling_factor().value_or(0);
  std::optional<SecondOrderDoubt> doubt;
  if (second->answer == BucklingAnswer::kNoStiffness) {
    doubt = SecondOrderDoubt::kNoStiffness;
  } else if (second->buckling_factor() && factor <= 1) {
    doubt = SecondOrderDoubt::kBuckles;
  } else if (breaks(ratio) != breaks(bent) || std::isnan(bent)) {
    doubt = SecondOrderDoubt::kLoads;
  } else if (!(second->facet_reserve_max <= 1) || second->leans_out) {
    doubt = SecondOrderDoubt::kTilts;
  }
  return doubt
             ? std::optional(Reason{.code = ReasonCode::kSecondOrder,
                                    .numbers = {static_cast<double>(*doubt), factor, ratio, bent}})
             : std::nullopt;
}

std::optional<Reason> second_order_warning(const Assessment& assessment) {
  const auto& second = assessment.second_order;
  const bool is_said =
      second && (second->trust == Trust::kNotTrusted ||
                 (second->trust == Trust::kNotCertain && second->is_modulus_stated));
  if (!is_said) {
    return std::nullopt;
  }
  const double ratio = assessment.load_ratio_max.value_or(0);
  return Reason{
      .code = ReasonCode::kBendingMatters,
      .numbers = {
          second->trust == Trust::kNotCertain ? 1.0 : 0.0, second->buckling_factor().value_or(0),
          ratio, second->load_ratio_max.value_or(ratio),
          second->is_modulus_stated ? 0 : second->elastic_modulus_needed_mpa().value_or(-1)}};
}

const char* name(Trust trust) {
  switch (trust) {
    case Trust::kTrusted:
      return "trusted";
    case Trust::kNotTrusted:
      return "not trusted";
    case Trust::kNotCertain:
      break;
  }
  return "not certain";
}

}  // namespace holdfast::verdict
