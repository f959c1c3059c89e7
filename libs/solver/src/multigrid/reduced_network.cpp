// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "reduced_network.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <span>

#include "../block_kernels.hpp"
#include "beam_shapes.hpp"
#include "holdfast/base/check.hpp"
#include "kernels.hpp"

namespace holdfast::solver {
namespace {

using base::Direction;
using base::Mat6;
using base::Vec6;
using host::Team;
using model::Robot;
using model::Support;

std::size_t at(std::int32_t index) { return static_cast<std::size_t>(index); }

Direction direction_of(std::size_t index) { return static_cast<Direction>(index); }

std::array<double, 3> unit_step(std::size_t direction) {
  std::array<double, 3> step{};
  step[direction / 2] = direction % 2 == 0 ? 1 : -1;
  return step;
}

/// A force at the tip of an arm, as force and torque at its root.
Vec6<double> moved(Vec6<double> force, std::size_t direction, double length) {
  const std::array<double, 3> step = unit_step(direction);
  force[3] += length * (step[1] * force[2] - step[2] * force[1]);
  force[4] += length * (step[2] * force[0] - step[0] * force[2]);
  force[5] += length * (step[0] * force[1] - step[1] * force[0]);
  return force;
}

/// The box around some cells.
struct Extent {
  base::Cell low = {std::numeric_limits<std::int32_t>::max(),
                    std::numeric_limits<std::int32_t>::max(),
                    std::numeric_limits<std::int32_t>::max()};
  base::Cell high = {std::numeric_limits<std::int32_t>::min(),
                     std::numeric_limits<std::int32_t>::min(),
                     std::numeric_limits<std::int32_t>::min()};

  void add(const base::Cell& cell) {
    low = {std::min(low.x, cell.x), std::min(low.y, cell.y), std::min(low.z, cell.z)};
    high = {std::max(high.x, cell.x), std::max(high.y, cell.y), std::max(high.z, cell.z)};
  }

  std::int32_t longest() const {
    return high.x < low.x ? 0 : std::max({high.x - low.x, high.y - low.y, high.z - low.z}) + 1;
  }
};

/// Spreads the low 21 bits to every third place.
std::uint64_t spread(std::uint64_t value) {
  value = (value | value << 32U) & 0x1f00000000ffffU;
  value = (value | value << 16U) & 0x1f0000ff0000ffU;
  value = (value | value << 8U) & 0x100f00f00f00f00fU;
  value = (value | value << 4U) & 0x10c30c30c30c30c3U;
  value = (value | value << 2U) & 0x1249249249249249U;
  return value;
}

struct Keyed {
  std::uint64_t key = 0;
  std::int32_t module = 0;
};

/// Least significant digit first; stable.
void radix_sort(std::vector<Keyed>& items) {
  constexpr unsigned kBits = 11;
  std::uint64_t all = 0;
  for (const Keyed& item : items) {
    all |= item.key;
  }
  std::vector<Keyed> sorted(items.size());
  for (unsigned shift = 0; shift < 64 && (all >> shift) != 0; shift += kBits) {
    std::array<std::size_t, (1U << kBits) + 1> start{};
    const auto digit = [&](const Keyed& item) { return (item.key >> shift) & ((1U << kBits) - 1); };
    for (const Keyed& item : items) {
      ++start[digit(item) + 1];
    }
    for (std::size_t i = 1; i < start.size(); ++i) {
      start[i] += start[i - 1];
    }
    for (const Keyed& item : items) {
      sorted[start[digit(item)]++] = item;
    }
    items.swap(sorted);
  }
}

/// Builds a network step by step.
class Builder {
 public:
  Builder(const Robot& robot, Team& team)
      : robot_(robot),
        team_(team),
        is_gone_(robot.modules().size(), 0),
        degree_(robot.modules().size()) {}

  ReducedNetwork build() {
    count_connections();
    take_hanging();
    take_runs();
    sort_nodes();
    colour_nodes();
    connect();
    return std::move(network_);
  }

 private:
  bool is_free(std::size_t module) const {
    return robot_.modules()[module].support == Support::kNone;
  }

  void count_connections() {
    team_.share(0, degree_.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) {
        int count = 0;
        for (const std::int32_t other : robot_.neighbours()[i]) {
          count += other == Robot::kNoNeighbour ? 0 : 1;
        }
        degree_[i] = static_cast<std::uint8_t>(count);
        is_gone_[i] = robot_.modules()[i].support == Support::kFixed ? 1 : 0;
      }
    });
  }

  std::size_t next(std::size_t module, std::size_t direction) const {
    return at(robot_.neighbours()[module][direction]);
  }

  bool is_connected(std::size_t module, std::size_t direction) const {
    const std::int32_t other = robot_.neighbours()[module][direction];
    return other != Robot::kNoNeighbour &&
           (is_gone_[at(other)] == 0 || robot_.modules()[at(other)].support == Support::kFixed);
  }

  /// Leaves first, until none is left.
  void take_hanging() {
    for (std::size_t start = 0; start < degree_.size(); ++start) {
      std::size_t leaf = start;
      while (is_gone_[leaf] == 0 && is_free(leaf) && degree_[leaf] == 1) {
        std::size_t direction = 0;
        while (!is_connected(leaf, direction)) {
          ++direction;
        }
        const std::size_t host = next(leaf, direction);
        is_gone_[leaf] = 1;
        network_.hanging.push_back({.module = static_cast<std::int32_t>(leaf),
                                    .direction = static_cast<std::uint8_t>(direction)});
        --degree_[host];
        leaf = host;
      }
    }
  }

  /// The axis along which a module only passes forces on, or -1.
  int axis_of_passage(std::size_t module) const {
    if (is_gone_[module] != 0 || !is_free(module) || degree_[module] != 2) {
      return -1;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (is_connected(module, 2 * axis) && is_connected(module, 2 * axis + 1)) {
        return static_cast<int>(axis);
      }
    }
    return -1;
  }

  void take_runs() {
    std::vector<std::int8_t> axis(degree_.size());
    bool is_any = false;
    for (std::size_t i = 0; i < axis.size(); ++i) {
      axis[i] = static_cast<std::int8_t>(axis_of_passage(i));
      is_any = is_any || axis[i] >= 0;
    }
    if (!is_any) {
      return;
    }
    for (std::size_t i = 0; i < axis.size(); ++i) {
      const bool is_end = axis[i] < 0 && (is_gone_[i] == 0 || !is_free(i));
      for (std::size_t direction = 0; is_end && direction < 6; direction += 2) {
        if (is_connected(i, direction) &&
            axis[next(i, direction)] == static_cast<int>(direction / 2)) {
          take_run(i, direction, axis);
        }
      }
    }
  }

  /// From an end along +x, +y or +z to the other end, in beams of at most kBeamLengthMax.
  void take_run(std::size_t from, std::size_t direction, const std::vector<std::int8_t>& axis) {
    bool is_at_end = false;
    while (!is_at_end) {
      std::size_t to = from;
      int length = 0;
      do {
        to = next(to, direction);
        ++length;
        is_at_end = axis[to] != static_cast<int>(direction / 2);
      } while (!is_at_end && length < kBeamLengthMax);
      if (length > 1) {
        join(from, direction, length);
      }
      from = to;
    }
  }

  void join(std::size_t from, std::size_t direction, int length) {
    network_.runs.push_back({.from = static_cast<std::int32_t>(from),
                             .direction = static_cast<std::uint8_t>(direction),
                             .length = length});
    network_.has_long_beams = true;
    std::size_t module = from;
    for (int i = 1; i < length; ++i) {
      module = next(module, direction);
      is_gone_[module] = 1;
    }
  }

  void sort_nodes() {
    const auto modules = robot_.modules();
    base::Cell low = modules[0].cell;
    for (const model::Module& module : modules) {
      low = {std::min(low.x, module.cell.x), std::min(low.y, module.cell.y),
             std::min(low.z, module.cell.z)};
    }
    items_.reserve(modules.size());
    Extent extent;
    for (std::size_t i = 0; i < modules.size(); ++i) {
      if (is_gone_[i] == 0) {
        const base::Cell& cell = modules[i].cell;
        extent.add(cell);
        items_.push_back({.key = spread(static_cast<std::uint64_t>(cell.x - low.x)) |
                                 spread(static_cast<std::uint64_t>(cell.y - low.y)) << 1U |
                                 spread(static_cast<std::uint64_t>(cell.z - low.z)) << 2U,
                          .module = static_cast<std::int32_t>(i)});
      }
    }
    radix_sort(items_);
    network_.node_count = items_.size();
    network_.extent = extent.longest();
  }

  /// End of a beam from a module, and its length; kNoNeighbour if there is none.
  std::int32_t far_end(std::size_t module, std::size_t direction, int& length) const {
    std::int32_t other = robot_.neighbours()[module][direction];
    length = 1;
    if (other == Robot::kNoNeighbour || !network_.is_reduced()) {
      return other;
    }
    while (is_gone_[at(other)] != 0 && is_free(at(other))) {
      if (degree_[at(other)] != 2 || axis_of_gone(at(other)) != direction / 2) {
        return Robot::kNoNeighbour;  // Hangs here.
      }
      other = robot_.neighbours()[at(other)][direction];
      ++length;
    }
    return other;
  }

  /// Of a module in a run; a hanging one has no such axis because its degree fell to 1.
  std::size_t axis_of_gone(std::size_t module) const { return run_axis_[module]; }

  void colour_nodes() {
    if (network_.has_long_beams) {
      run_axis_.assign(degree_.size(), 3);
      for (const ReducedNetwork::Run& run : network_.runs) {
        std::size_t module = at(run.from);
        for (int i = 1; i < run.length; ++i) {
          module = next(module, run.direction);
          run_axis_[module] = static_cast<std::uint8_t>(run.direction / 2U);
        }
      }
    } else if (network_.is_reduced()) {
      run_axis_.assign(degree_.size(), 3);
    }
    constexpr std::uint8_t kNone = 255;
    std::vector<std::uint8_t> colour(degree_.size(), kNone);
    std::array<std::size_t, 8> count{};
    for (const Keyed& item : items_) {
      unsigned taken = 0;
      for (std::size_t direction = 0; direction < 6; ++direction) {
        int length = 0;
        const std::int32_t other = far_end(at(item.module), direction, length);
        if (other != Robot::kNoNeighbour && colour[at(other)] != kNone) {
          taken |= 1U << colour[at(other)];
        }
      }
      const auto free = static_cast<std::uint8_t>(std::countr_one(taken));
      colour[at(item.module)] = free;
      ++count[free];
    }
    std::array<std::size_t, 9> start{};
    network_.colour_start = {0};
    for (std::size_t c = 0; c < 8 && count[c] > 0; ++c) {
      start[c + 1] = start[c] + count[c];
      network_.colour_start.push_back(start[c + 1]);
    }
    node_of_.assign(degree_.size(), static_cast<std::int32_t>(network_.node_count));
    network_.module.resize(items_.size());
    network_.order.reserve(items_.size());
    network_.key.reserve(items_.size());
    for (const Keyed& item : items_) {
      const std::size_t node = start[colour[at(item.module)]]++;
      node_of_[at(item.module)] = static_cast<std::int32_t>(node);
      network_.module[node] = item.module;
      network_.order.push_back(static_cast<std::int32_t>(node));
      network_.key.push_back(item.key);
    }
    items_ = {};
  }

  void connect() {
    network_.other.resize(network_.node_count);
    network_.kind.resize(network_.node_count);
    team_.share(0, network_.node_count, [&](std::size_t begin, std::size_t end) {
      for (std::size_t node = begin; node < end; ++node) {
        connect(node);
      }
    });
  }

  void connect(std::size_t node) {
    const std::size_t module = at(network_.module[node]);
    Kind kind{};
    for (std::size_t direction = 0; direction < 6; ++direction) {
      int length = 0;
      const std::int32_t other = far_end(module, direction, length);
      const bool is_there = other != Robot::kNoNeighbour;
      network_.other[node][direction] =
          is_there ? node_of_[at(other)] : static_cast<std::int32_t>(network_.node_count);
      kind[direction] = static_cast<std::uint8_t>(is_there ? length : 0);
    }
    if (robot_.modules()[module].support == Support::kGround) {
      kind[base::index(Direction::kMinusZ)] = 1;
    }
    network_.kind[node] = kind;
  }

  const Robot& robot_;
  Team& team_;
  std::vector<std::uint8_t> is_gone_;  ///< Eliminated or fixed.
  std::vector<std::uint8_t> degree_;   ///< Connections that are left.
  std::vector<std::uint8_t> run_axis_;
  std::vector<Keyed> items_;
  std::vector<std::int32_t> node_of_;
  ReducedNetwork network_;
};

/// K^-1 as a matrix; the blocks of a beam are regular.
Mat6<double> inverse_of(const Mat6<double>& block) {
  Mat6<double> inverse;
  HOLDFAST_CHECK(invert(block, inverse));
  return inverse;
}

/// Block elimination along a run, from its first inner module to its last: the same for all runs of
/// one direction and length.
struct RunFactor {
  std::vector<Mat6<double>> pivot;   ///< Inverse of what is left of K_ii.
  std::vector<Mat6<double>> factor;  ///< K_i,i-1 times the pivot before.
  Mat6<double> to_next;              ///< K12 onwards and backwards.
  Mat6<double> to_last;
  Vec6<double> weight{};            ///< Of one module.
  std::vector<Vec6<double>> plain;  ///< How far weights bend it while its ends are held.
};

RunFactor factorize_run(const mechanics::BeamStiffness<double>& beam, std::size_t direction,
                        int length) {
  RunFactor run;
  run.to_next = mechanics::block_12(beam, direction_of(direction));
  run.to_last = mechanics::block_12(beam, direction_of(direction ^ 1U));
  Mat6<double> both = mechanics::block_11(beam, direction_of(direction));
  base::add_to(both, mechanics::block_11(beam, direction_of(direction ^ 1U)));
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

/// From the loads of a run's inner modules to how far these bend it while its ends are held.
void bend(const RunFactor& factor, std::span<Vec6<double>> load) {
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

/// Of one run. Most carry nothing but themselves, and bend alike.
void bend_run(const Robot& robot, const ReducedNetwork::Run& run, const RunFactor& factor,
              std::vector<Vec6<double>>& load) {
  std::array<std::size_t, kBeamLengthMax> modules{};
  std::array<Vec6<double>, kBeamLengthMax> own;
  const std::size_t count = at(run.length) - 1;
  std::size_t module = at(run.from);
  bool is_plain = true;
  for (std::size_t i = 0; i < count; ++i) {
    module = at(robot.neighbours()[module][run.direction]);
    modules[i] = module;
    own[i] = load[module];
    is_plain = is_plain && own[i] == factor.weight;
  }
  if (!is_plain) {
    bend(factor, std::span(own).first(count));
  }
  for (std::size_t i = 0; i < count; ++i) {
    load[modules[i]] = is_plain ? factor.plain[i] : own[i];
  }
}

/// Carries the load of a run's inner modules to its ends.
void carry_to_ends(const Robot& robot, const ReducedNetwork::Run& run,
                   const std::vector<BeamShape>& shapes, std::vector<Vec6<double>>& load) {
  Vec6<double> near{};
  Vec6<double> far{};
  std::size_t module = at(run.from);
  for (int i = 1; i < run.length; ++i) {
    module = at(robot.neighbours()[module][run.direction]);
    add_share(shapes[at(i)], run.direction, load[module], near);
    add_share(shapes[at(run.length - i)], run.direction ^ 1U, load[module], far);
  }
  base::add_to(load[at(run.from)], near);
  base::add_to(load[at(robot.neighbours()[module][run.direction])], far);
}

/// All runs and hanging modules: from loads to what bends while the ends, or the host, are held.
void bend_alone(const Robot& robot, Team& team, ReducedNetwork& network) {
  const auto beam = long_beam(robot.material(), 1);
  std::array<std::vector<RunFactor>, 6> factors;
  std::array<Mat6<double>, 6> inverse_11;
  for (std::size_t d = 0; d < 6; ++d) {
    inverse_11[d] = inverse_of(mechanics::block_11(beam, direction_of(d)));
    factors[d].resize(kBeamLengthMax + 1);
  }
  for (const ReducedNetwork::Run& run : network.runs) {
    RunFactor& factor = factors[run.direction][at(run.length)];
    if (factor.pivot.empty()) {
      factor = factorize_run(beam, run.direction, run.length);
      factor.weight = {0, 0, -model::module_weight_n(robot.material()), 0, 0, 0};
      factor.plain.assign(factor.pivot.size(), factor.weight);
      bend(factor, factor.plain);
    }
  }
  team.share(0, network.runs.size(), [&](std::size_t begin, std::size_t end) {
    for (const ReducedNetwork::Run& run : std::span(network.runs).subspan(begin, end - begin)) {
      bend_run(robot, run, factors[run.direction][at(run.length)], network.load);
    }
  });
  team.share(0, network.hanging.size(), [&](std::size_t begin, std::size_t end) {
    for (const auto& [module, direction] : std::span(network.hanging).subspan(begin, end - begin)) {
      network.load[at(module)] = multiply(inverse_11[direction], network.load[at(module)]);
    }
  });
}

void recover_run(const Robot& robot, const ReducedNetwork& network, const ReducedNetwork::Run& run,
                 const std::vector<BeamShape>& shapes, std::vector<Vec6<double>>& displacement) {
  std::array<std::size_t, kBeamLengthMax + 1> modules{};
  modules[0] = at(run.from);
  const std::size_t length = at(run.length);
  for (std::size_t i = 1; i <= length; ++i) {
    modules[i] = at(robot.neighbours()[modules[i - 1]][run.direction]);
  }
  const Vec6<double> near = displacement[modules[0]];
  const Vec6<double> far = displacement[modules[length]];
  for (std::size_t i = 1; i < length; ++i) {
    Vec6<double> u = network.load[modules[i]];
    add_motion(shapes[i], run.direction, near, u);
    add_motion(shapes[length - i], run.direction ^ 1U, far, u);
    displacement[modules[i]] = u;
  }
}

}  // namespace

mechanics::BeamStiffness<double> long_beam(const model::Material& material, int length) {
  mechanics::BeamSection<double> section = model::beam_section(material);
  section.length *= length;
  return mechanics::beam_stiffness(section);
}

ReducedNetwork make_reduced_network(const Robot& robot, Team& team) {
  ReducedNetwork network = Builder(robot, team).build();
  if (network.is_reduced()) {
    const Vec6<double> weight = {0, 0, -model::module_weight_n(robot.material()), 0, 0, 0};
    carry(robot, team, std::vector<Vec6<double>>(robot.modules().size(), weight), network);
  }
  return network;
}

void carry(const Robot& robot, Team& team, std::vector<Vec6<double>> load,
           ReducedNetwork& network) {
  network.load = std::move(load);
  const double pitch = robot.material().pitch_mm;
  for (const auto& [module, direction] : network.hanging) {
    const std::size_t host = at(robot.neighbours()[at(module)][direction]);
    base::add_to(network.load[host], moved(network.load[at(module)], direction ^ 1U, pitch));
  }
  ShapeTable shapes(pitch);
  for (const ReducedNetwork::Run& run : network.runs) {
    carry_to_ends(robot, run, shapes.of(run.length), network.load);
  }
  bend_alone(robot, team, network);
}

void recover(const Robot& robot, const ReducedNetwork& network, Team& team,
             std::vector<Vec6<double>>& displacement) {
  ShapeTable shapes(robot.material().pitch_mm);
  for (const ReducedNetwork::Run& run : network.runs) {
    shapes.of(run.length);
  }
  team.share(0, network.runs.size(), [&](std::size_t begin, std::size_t end) {
    for (const ReducedNetwork::Run& run : std::span(network.runs).subspan(begin, end - begin)) {
      recover_run(robot, network, run, shapes.known(run.length), displacement);
    }
  });
  for (std::size_t i = network.hanging.size(); i-- > 0;) {
    const auto [module, direction] = network.hanging[i];
    const std::size_t host = at(robot.neighbours()[at(module)][direction]);
    Vec6<double>& u = displacement[at(module)];
    u = displacement[host];  // As one rigid body, from the host to what hangs on it.
    const auto [a, j, k, sign] = Axes(direction ^ 1U);
    const double arm = sign * robot.material().pitch_mm;
    u[j] += arm * u[k + 3];
    u[k] -= arm * u[j + 3];
    base::add_to(u, network.load[at(module)]);
  }
}

}  // namespace holdfast::solver
