// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "multigrid/hierarchy/condensation.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

#include "holdfast/base/algebra.hpp"
#include "multigrid/hierarchy/matrix_blocks.hpp"
#include "multigrid/kernels/beam_shapes.hpp"

namespace holdfast::solver {
namespace {

using base::at;
using base::Direction;
using base::Mat6;
using base::Vec6;
using host::Team;
using model::Robot;

Direction direction_of(std::size_t index) { return static_cast<Direction>(index); }

/// The directions in which a robot's beams lead. Along the axes, as in cubes, fewer numbers round.
class Ways {
 public:
  explicit Ways(const Robot& robot)
      : is_cubic_(base::unstretched(robot.lattice()) == base::kCubic) {
    for (const Direction direction : base::directions(robot.lattice())) {
      const std::size_t d = at(base::index(direction));
      unit_[d] = base::heading(robot.lattice(), direction);
      length_mm_[d] = robot.material().pitch_mm * base::step_length(robot.lattice(), direction);
    }
  }

  const std::array<double, 3>& unit(std::size_t direction) const { return unit_[direction]; }

  /// The length of a beam from node to node.
  double length_mm(std::size_t direction) const { return length_mm_[direction]; }

  void add_motion(const BeamShape& shape, std::size_t direction, const Vec6<double>& end,
                  Vec6<double>& u) const {
    is_cubic_ ? solver::add_motion(shape, direction, end, u)
              : solver::add_motion(shape, unit_[direction], end, u);
  }

  void add_share(const BeamShape& shape, std::size_t direction, const Vec6<double>& force,
                 Vec6<double>& load) const {
    is_cubic_ ? solver::add_share(shape, direction, force, load)
              : solver::add_share(shape, unit_[direction], force, load);
  }

 private:
  bool is_cubic_;
  std::array<std::array<double, 3>, base::Lattice::kDirectionCountMax> unit_{};
  std::array<double, base::Lattice::kDirectionCountMax> length_mm_{};
};

/// The shapes of beams, by direction.
std::vector<ShapeTable> shape_tables(const Robot& robot, const Ways& ways) {
  std::vector<ShapeTable> tables;
  for (std::size_t d = 0; d < at(robot.lattice().direction_count); ++d) {
    tables.emplace_back(ways.length_mm(d));
  }
  return tables;
}

/// A force at the tip of an arm, as force and torque at its root.
Vec6<double> moved(Vec6<double> force, const std::array<double, 3>& step, double length) {
  force[3] += length * (step[1] * force[2] - step[2] * force[1]);
  force[4] += length * (step[2] * force[0] - step[0] * force[2]);
  force[5] += length * (step[0] * force[1] - step[1] * force[0]);
  return force;
}

/// Block elimination along a run, from its first inner module to its last: the same for all runs of
/// one direction and length.
struct RunFactor {
  std::vector<Mat6<double>> pivot;   ///< Inverse of what is left of K_ii.
  std::vector<Mat6<double>> factor;  ///< K_i,i-1 times the pivot before.
  Mat6<double> to_next;              ///< K12 onwards and backwards.
  Mat6<double> to_last;
  Vec6<double> common{};                          ///< The load that most modules carry,
  std::vector<Vec6<double>> common_displacement;  ///< and what it does to a run that carries it.
};

RunFactor factorize_run(const model::LatticeBeam<double>& beam, std::size_t direction, int length) {
  RunFactor run;
  run.to_next = beam.block_12(direction_of(direction));
  run.to_last = beam.block_12(direction_of(direction ^ 1U));
  Mat6<double> both = beam.block_11(direction_of(direction));
  base::add_to(both, beam.block_11(direction_of(direction ^ 1U)));
  for (int i = 1; i < length; ++i) {
    Mat6<double> diagonal = both;
    run.factor.push_back(i == 1 ? run.to_last : product(run.to_last, run.pivot.back()));
    if (i > 1) {
      subtract_product(diagonal, run.factor.back(), run.to_next);
    }
    run.pivot.push_back(inverse_of(diagonal));
  }
  return run;
}

/// Turns the loads of a run's inner modules into their displacements while the run's ends are held.
void apply_flexibility(const RunFactor& factor, std::span<Vec6<double>> load) {
  for (std::size_t i = 1; i < load.size(); ++i) {
    subtract_product(load[i], factor.factor[i], load[i - 1]);
  }
  for (std::size_t i = load.size(); i-- > 0;) {
    if (i + 1 < load.size()) {
      subtract_product(load[i], factor.to_next, load[i + 1]);
    }
    load[i] = multiply(factor.pivot[i], load[i]);
  }
}

/// Applies the flexibility of one run. Most runs carry nothing but the common load, and bend alike.
void apply_flexibility(const Robot& robot, const Run& run, const RunFactor& factor,
                       std::vector<Vec6<double>>& load) {
  std::array<std::size_t, kBeamLengthMax> modules{};
  std::array<Vec6<double>, kBeamLengthMax> own;
  const std::size_t count = at(run.length) - 1;
  std::size_t module = at(run.from);
  bool is_common = true;
  for (std::size_t i = 0; i < count; ++i) {
    module = at(robot.connected()[module][run.direction]);
    modules[i] = module;
    own[i] = load[module];
    is_common = is_common && own[i] == factor.common;
  }
  if (!is_common) {
    apply_flexibility(factor, std::span(own).first(count));
  }
  for (std::size_t i = 0; i < count; ++i) {
    load[modules[i]] = is_common ? factor.common_displacement[i] : own[i];
  }
}

/// Adds what a run's inner modules carry to the loads of its ends.
void move_loads_to_ends(const Robot& robot, const Ways& ways, const Run& run,
                        const std::vector<BeamShape>& shapes, std::vector<Vec6<double>>& load) {
  Vec6<double> near{};
  Vec6<double> far{};
  std::size_t module = at(run.from);
  for (int i = 1; i < run.length; ++i) {
    module = at(robot.connected()[module][run.direction]);
    ways.add_share(shapes[at(i)], run.direction, load[module], near);
    ways.add_share(shapes[at(run.length - i)], run.direction ^ 1U, load[module], far);
  }
  base::add_to(load[at(run.from)], near);
  base::add_to(load[at(robot.connected()[module][run.direction])], far);
}

/// The factors of all runs that a network has, by direction and length.
using RunFactors = std::array<std::vector<RunFactor>, base::Lattice::kDirectionCountMax>;

RunFactors factorize_runs(const ReducedNetwork& network, const model::LatticeBeam<double>& beam,
                          const Vec6<double>& common) {
  RunFactors factors;
  factors.fill(std::vector<RunFactor>(kBeamLengthMax + 1));
  for (const Run& run : network.runs) {
    RunFactor& factor = factors[run.direction][at(run.length)];
    if (factor.pivot.empty()) {
      factor = factorize_run(beam, run.direction, run.length);
      factor.common = common;
      factor.common_displacement.assign(factor.pivot.size(), common);
      apply_flexibility(factor, factor.common_displacement);
    }
  }
  return factors;
}

/// Turns the loads of all eliminated modules into displacements while the ends of their run, or
/// their hosts, are held.
void apply_flexibilities(const Robot& robot, const ReducedNetwork& network, Team& team,
                         const Vec6<double>& common, std::vector<Vec6<double>>& load) {
  const auto beam = long_beam(robot.material(), robot.lattice(), 1);
  const RunFactors factors = factorize_runs(network, beam, common);
  std::vector<Mat6<double>> inverse_11(at(robot.lattice().direction_count));
  for (std::size_t d = 0; d < inverse_11.size(); ++d) {
    inverse_11[d] = inverse_of(beam.block_11(direction_of(d)));
  }
  team.share(0, network.runs.size(), [&](std::size_t begin, std::size_t end) {
    for (const Run& run : std::span(network.runs).subspan(begin, end - begin)) {
      apply_flexibility(robot, run, factors[run.direction][at(run.length)], load);
    }
  });
  team.share(0, network.hanging.size(), [&](std::size_t begin, std::size_t end) {
    for (const auto& [module, direction] : std::span(network.hanging).subspan(begin, end - begin)) {
      load[at(module)] = multiply(inverse_11[direction], load[at(module)]);
    }
  });
}

/// Moves a run's inner modules with its ends, and by what their loads do.
void recover_run(const Robot& robot, const Ways& ways, const Run& run,
                 const std::vector<BeamShape>& shapes, const model::Loads& loads,
                 const CondensedLoads& condensed, std::vector<Vec6<double>>& displacement) {
  std::array<std::size_t, kBeamLengthMax + 1> modules{};
  modules[0] = at(run.from);
  const std::size_t length = at(run.length);
  for (std::size_t i = 1; i <= length; ++i) {
    modules[i] = at(robot.connected()[modules[i - 1]][run.direction]);
  }
  const Vec6<double> near = displacement[modules[0]];
  const Vec6<double> far = displacement[modules[length]];
  for (std::size_t i = 1; i < length; ++i) {
    Vec6<double> u = condensed.of(modules[i], loads);
    ways.add_motion(shapes[i], run.direction, near, u);
    ways.add_motion(shapes[length - i], run.direction ^ 1U, far, u);
    displacement[modules[i]] = u;
  }
}

void update(host::Halo& copies, std::vector<Vec6<double>>& by_module) {
  copies.update(by_module.data(), sizeof(Vec6<double>));
}

/// The modules of a network's hanging trees which go in one round, in the order of elimination.
std::span<const HangingModule> round_of(const ReducedNetwork& network, std::size_t round) {
  const std::size_t begin = network.round_start[round];
  return std::span(network.hanging).subspan(begin, network.round_start[round + 1] - begin);
}

/// Moves hanging modules with their hosts, as one rigid body, and by what their loads do.
void recover_hanging(const Robot& robot, const Ways& ways, std::span<const HangingModule> hanging,
                     const model::Loads& loads, const CondensedLoads& condensed,
                     std::vector<Vec6<double>>& displacement) {
  for (std::size_t i = hanging.size(); i-- > 0;) {
    const auto [module, direction] = hanging[i];
    const std::size_t host = at(robot.connected()[at(module)][direction]);
    Vec6<double>& u = displacement[at(module)];
    u = displacement[host];
    const Point arm = scaled(ways.unit(direction ^ 1U), ways.length_mm(direction));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const std::size_t j = (axis + 1) % 3;
      const std::size_t k = (axis + 2) % 3;
      u[axis] += u[j + 3] * arm[k] - u[k + 3] * arm[j];
    }
    base::add_to(u, condensed.of(at(module), loads));
  }
}

}  // namespace

CondensedLoads::CondensedLoads(const std::vector<Load>& loads, const model::Loads& own)
    : marks_((loads.size() + kBits - 1) / kBits) {
  before_.reserve(marks_.size());
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < marks_.size(); ++i) {
    before_.push_back(count);
    for (std::size_t module = kBits * i; module < std::min(kBits * (i + 1), loads.size());
         ++module) {
      marks_[i] |= std::uint64_t{loads[module] != own[module]} << module % kBits;
    }
    count += static_cast<std::uint32_t>(std::popcount(marks_[i]));
  }
  kept_.reserve(count);
  for (std::size_t i = 0; i < marks_.size(); ++i) {
    for (std::uint64_t marks = marks_[i]; marks != 0; marks &= marks - 1) {
      kept_.push_back(loads[kBits * i + static_cast<std::size_t>(std::countr_zero(marks))]);
    }
  }
}

CondensedLoads condense(const Robot& robot, const ReducedNetwork& network, Team& team,
                        const model::Loads& loads, host::Halo& copies) {
  std::vector<Vec6<double>> load(robot.modules().size());
  team.share(0, load.size(), [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      load[i] = loads[i];
    }
  });
  update(copies, load);  // What modules carry is known to their own rank alone.
  const Ways ways(robot);
  for (std::size_t round = 0; round + 1 < network.round_start.size(); ++round) {
    for (const auto& [module, direction] : round_of(network, round)) {
      const std::size_t host = at(robot.connected()[at(module)][direction]);
      base::add_to(load[host],
                   moved(load[at(module)], ways.unit(direction ^ 1U), ways.length_mm(direction)));
    }
    update(copies, load);
  }
  std::vector<ShapeTable> shapes = shape_tables(robot, ways);
  for (const Run& run : network.runs) {
    move_loads_to_ends(robot, ways, run, shapes[run.direction].of(run.length), load);
  }
  const Vec6<double> common = loads.is_uniform() ? loads[0] : Vec6<double>{};
  apply_flexibilities(robot, network, team, common, load);
  return {load, loads};
}

void recover(const Robot& robot, const ReducedNetwork& network, Team& team,
             const model::Loads& loads, const CondensedLoads& condensed,
             std::vector<Vec6<double>>& displacement, host::Halo& copies) {
  const Ways ways(robot);
  std::vector<ShapeTable> shapes = shape_tables(robot, ways);
  for (const Run& run : network.runs) {
    shapes[run.direction].of(run.length);
  }
  team.share(0, network.runs.size(), [&](std::size_t begin, std::size_t end) {
    for (const Run& run : std::span(network.runs).subspan(begin, end - begin)) {
      recover_run(robot, ways, run, shapes[run.direction].known(run.length), loads, condensed,
                  displacement);
    }
  });
  for (std::size_t round = network.round_start.size() - 1; round-- > 0;) {
    update(copies, displacement);
    recover_hanging(robot, ways, round_of(network, round), loads, condensed, displacement);
  }
  if (network.round_start.size() > 1) {
    update(copies, displacement);
  }
}

}  // namespace holdfast::solver
