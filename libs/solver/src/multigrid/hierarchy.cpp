// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "hierarchy.hpp"

#include <algorithm>
#include <bit>
#include <type_traits>
#include <unordered_map>
#include <utility>

#include "../block_kernels.hpp"
#include "block_pool.hpp"
#include "holdfast/base/check.hpp"

namespace holdfast::solver {
namespace {

using base::Direction;

constexpr std::size_t kRow = kBeamLengthMax + 1;

/// A level this small is factorized whatever its shape: it costs nothing.
constexpr std::size_t kCoarsestCount = 48;

/// The factors of a longer chain of clusters have lost too many digits. In double precision they
/// are refined with forces that have not, and that counts; in single precision there are none to
/// lose.
template <class Real>
constexpr std::size_t kChainMax = std::is_same_v<Real, float> ? 1600 : 600;

/// Where nodes have more neighbours than this on average, too many blocks fill in.
constexpr std::size_t kThinDegree = 3;

std::size_t at(std::int32_t index) { return static_cast<std::size_t>(index); }

/// Which displacement bends with which on a beam along an axis; see kernel_loops.hpp.
constexpr std::size_t kSwap[3][6] = {{0, 5, 4, 3, 2, 1}, {5, 1, 3, 2, 4, 0}, {4, 3, 2, 1, 0, 5}};

template <class Real>
Block<Real> block_of(const Mat& matrix) {
  Block<Real> block;
  for (int column = 0; column < 6; ++column) {
    for (int row = 0; row < 6; ++row) {
      block.column[column][row] = static_cast<Real>(matrix.at(row, column));
    }
  }
  return block;
}

Mat inverse_of(const Mat& matrix) {
  Mat inverse;
  HOLDFAST_CHECK(invert(matrix, inverse));
  return inverse;
}

BeamRow<double> beam_row(const Mat& k12, std::size_t axis) {
  BeamRow<double> row;
  for (std::size_t i = 0; i < 6; ++i) {
    const std::size_t j = kSwap[axis][i];
    row.direct.v[i] = k12.at(static_cast<int>(i), static_cast<int>(i));
    row.crossed.v[i] = i == j ? 0 : k12.at(static_cast<int>(i), static_cast<int>(j));
  }
  return row;
}

BeamRow<float> single(const BeamRow<double>& row) {
  BeamRow<float> result;
  for (std::size_t i = 0; i < 6; ++i) {
    result.direct.v[i] = static_cast<float>(row.direct.v[i]);
    result.crossed.v[i] = static_cast<float>(row.crossed.v[i]);
  }
  return result;
}

/// How stiff a beam is against what its middle sees. K12 has that but for the share of the shear
/// force in bending: -k + shear * (length/2)^2.
Six<double> middle_stiffness(const Mat& k12, std::size_t axis, double length) {
  Six<double> stiffness;
  for (std::size_t i = 0; i < 6; ++i) {
    stiffness.v[i] = -k12.at(static_cast<int>(i), static_cast<int>(i));
  }
  for (std::size_t i = 3; i < 6; ++i) {
    const std::size_t sheared = kSwap[axis][i];
    stiffness.v[i] += sheared == i ? 0 : stiffness.v[sheared] * length * length / 4;
  }
  return stiffness;
}

/// The sum of a node's springs, anchors left out.
Mat spring_sum(const Stage& stage, std::size_t node) {
  Mat sum;
  const std::size_t count = at(stage.start[node + 1] - stage.start[node]);
  for (std::size_t i = 0; i < count; ++i) {
    base::add_to(sum, stage.springs[stage.pattern[node] + i].stiffness);
  }
  return sum;
}

Mat coupling(const Spring& spring) {
  return scaled(times_carry(spring.stiffness, difference({}, spring.partner)), -1);
}

/// Calls f(node, other, spring) for every spring once.
template <class F>
void for_springs(const Stage& stage, const F& f) {
  for (std::size_t node = 0; node < stage.order.size(); ++node) {
    const std::size_t start = at(stage.start[node]);
    for (std::size_t e = start; e < at(stage.start[node + 1]); ++e) {
      if (at(stage.other[e]) > node) {
        f(static_cast<std::int32_t>(node), stage.other[e],
          stage.springs[stage.pattern[node] + e - start]);
      }
    }
  }
}

/// The whole level as a sparse matrix in double precision, as yet without anchors.
std::optional<BlockLu> unheld_matrix(const Stage& stage, std::size_t block_count_max) {
  std::vector<Edge> edges;
  for_springs(stage, [&](std::int32_t a, std::int32_t b, const Spring&) {
    edges.push_back({a, b});
  });
  BlockLu lu(stage.order.size(), edges, block_count_max);
  if (lu.is_too_large()) {
    return std::nullopt;
  }
  std::size_t edge = 0;
  for_springs(stage, [&](std::int32_t, std::int32_t, const Spring& spring) {
    lu.set_edge(edge++, coupling(spring));
  });
  for (std::size_t node = 0; node < stage.order.size(); ++node) {
    lu.set_diagonal(node, spring_sum(stage, node));
  }
  return lu;
}

/// Cells from Morton keys, as positions.
Point place_of(std::uint64_t key, double pitch) {
  std::array<std::uint64_t, 3> cell{};
  for (unsigned bit = 0; (key >> (3 * bit)) != 0; ++bit) {
    for (unsigned axis = 0; axis < 3; ++axis) {
      cell[axis] |= ((key >> (3 * bit + axis)) & 1U) << bit;
    }
  }
  return {pitch * static_cast<double>(cell[0]), pitch * static_cast<double>(cell[1]),
          pitch * static_cast<double>(cell[2])};
}

template <class Real>
void fill_vectors(Level<Real>& level) {
  level.r.assign(level.node_count + 1, {});
  level.z.assign(level.node_count + 1, {});
}

}  // namespace

/// The finest level: nodes of the same kind with partners on the same sides share their springs.
template <class Real>
void Hierarchy<Real>::fill_stage(Team& team, Stage& stage) const {
  const std::size_t count = network_.node_count;
  stage.order = network_.order;
  stage.key.resize(count);
  stage.place.resize(count);
  stage.box.resize(std::is_same_v<Real, double> ? count : 0);
  team.share(0, count, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const std::size_t node = at(network_.order[i]);
      stage.key[node] = network_.key[i];
      stage.place[node] = place_of(network_.key[i], material_.pitch_mm);
      if constexpr (std::is_same_v<Real, double>) {
        const Point cell = place_of(network_.key[i], 1);
        stage.box[node].low = {static_cast<std::int32_t>(cell[0]),
                               static_cast<std::int32_t>(cell[1]),
                               static_cast<std::int32_t>(cell[2])};
        stage.box[node].high = stage.box[node].low;
      }
    }
  });
  stage.start.resize(count + 1);
  stage.other.reserve(6 * count);
  stage.pattern.resize(count);
  std::unordered_map<std::uint64_t, std::uint32_t> patterns;
  for (std::size_t node = 0; node < count; ++node) {
    Kind kind{};
    for (std::size_t d = 0; d < 6; ++d) {
      const std::size_t length = network_.kind[node][d];
      if (length > 0 && at(network_.other[node][d]) < count) {
        kind[d] = static_cast<std::uint8_t>(length);
        stage.other.push_back(network_.other[node][d]);
      }
    }
    stage.start[node + 1] = static_cast<std::int32_t>(stage.other.size());
    const auto [found, is_new] = patterns.try_emplace(
        std::bit_cast<std::uint64_t>(kind), static_cast<std::uint32_t>(stage.springs.size()));
    stage.pattern[node] = found->second;
    for (std::size_t d = 0; is_new && d < 6; ++d) {
      if (kind[d] > 0) {
        stage.springs.push_back(beam_spring(material_, d, kind[d]));
      }
    }
  }
}

template <>
void Hierarchy<float>::make_beams() {
  const std::size_t length_max = network_.has_long_beams ? kBeamLengthMax : 1;
  beams_.rows.resize(6 * kRow);
  beams_.rows_double.resize(6 * kRow);
  for (std::size_t length = 1; length <= length_max; ++length) {
    const auto beam = long_beam(material_, static_cast<int>(length));
    for (std::size_t d = 0; d < 6; ++d) {
      const Mat k12 = mechanics::block_12(beam, static_cast<Direction>(d));
      beams_.rows_double[d * kRow + length] = beam_row(k12, d / 2);
      beams_.rows[d * kRow + length] = single(beams_.rows_double[d * kRow + length]);
    }
  }
}

template <>
void Hierarchy<double>::make_beams() {
  beams_.springs.resize(3 * kRow);
  for (std::size_t length = 1; length < kRow; ++length) {
    const auto beam = long_beam(material_, static_cast<int>(length));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      beams_.springs[axis * kRow + length] =
          middle_stiffness(mechanics::block_12(beam, static_cast<Direction>(2 * axis)), axis,
                           material_.pitch_mm * static_cast<double>(length));
    }
  }
}

template <class Real>
void Hierarchy<Real>::make_lattice() {
  make_beams();
  Level<Real>& level = levels_.emplace_back();
  level.node_count = network_.node_count;
  level.colour_start = network_.colour_start;
  level.type.resize(network_.node_count);
  fill_vectors(level);
  for (std::size_t node = 0; node < network_.node_count; ++node) {
    set_type(node);
  }
  point_at_lattice();
}

/// K_pp of a node on the finest level.
template <class Real>
Mat Hierarchy<Real>::diagonal(const Kind& kind) const {
  Mat sum;
  for (std::size_t d = 0; d < 6; ++d) {
    if (kind[d] > 0) {
      base::add_to(sum,
                   mechanics::block_11(long_beam(material_, kind[d]), static_cast<Direction>(d)));
    }
  }
  if (kind[kContactByte] != 0) {
    base::add_to(sum, ground_(kind[kContactByte]));
  }
  return sum;
}

template <>
void Hierarchy<float>::add_type(const Kind& kind) {
  const Mat sum = diagonal(kind);
  levels_.front().inverse.push_back(block_of<float>(inverse_of(sum)));
  beams_.diagonal.push_back(block_of<float>(sum));
  beams_.diagonal_double.push_back(block_of<double>(sum));
}

template <>
void Hierarchy<double>::add_type(const Kind& kind) {
  levels_.front().inverse.push_back(block_of<double>(inverse_of(diagonal(kind))));
  const std::uint8_t code = kind[kContactByte];
  beams_.ground.push_back(code == 0 ? Block<double>{} : block_of<double>(ground_(code)));
}

template <class Real>
void Hierarchy<Real>::set_type(std::size_t node) {
  const auto kind = std::bit_cast<std::uint64_t>(network_.kind[node]);
  const auto [found, is_new] =
      type_of_kind_.try_emplace(kind, static_cast<std::uint32_t>(type_of_kind_.size()));
  levels_.front().type[node] = found->second;
  if (is_new) {
    add_type(network_.kind[node]);
  }
}

template <>
void Hierarchy<float>::point_at_lattice() {
  const Level<float>& level = levels_.front();
  lattice_ = {.other = network_.other.data(),
              .kind = network_.has_long_beams ? network_.kind.data() : nullptr,
              .type = level.type.data(),
              .inverse = level.inverse.data(),
              .beams = beams_.rows.data(),
              .diagonal = beams_.diagonal.data(),
              .beams_double = beams_.rows_double.data(),
              .diagonal_double = beams_.diagonal_double.data()};
}

template <>
void Hierarchy<double>::point_at_lattice() {
  const Level<double>& level = levels_.front();
  lattice_ = {.other = network_.other.data(),
              .kind = network_.kind.data(),
              .type = level.type.data(),
              .inverse = level.inverse.data(),
              .springs = beams_.springs.data(),
              .ground = beams_.ground.data(),
              .pitch = material_.pitch_mm};
}

template <>
void Hierarchy<float>::couple(const Stage& stage, Level<float>& level) const {
  BlockPool<float> pool;
  std::vector<std::uint32_t> block_of_spring(stage.springs.size());
  for (std::size_t i = 0; i < stage.springs.size(); ++i) {
    block_of_spring[i] = pool.insert(block_of<float>(coupling(stage.springs[i])));
  }
  level.couplings.blocks = pool.take();
  level.couplings.block.resize(level.other.size());
  for (std::size_t node = 0; node < level.node_count; ++node) {
    const std::size_t start = at(stage.start[node]);
    for (std::size_t e = start; e < at(stage.start[node + 1]); ++e) {
      level.couplings.block[e] = block_of_spring[stage.pattern[node] + e - start];
    }
  }
}

template <>
void Hierarchy<double>::couple(const Stage& stage, Level<double>& level) const {
  for (const Spring& spring : stage.springs) {
    level.couplings.springs.push_back(
        {.stiffness = block_of<double>(spring.stiffness),
         .arm = {-spring.partner[0], -spring.partner[1], -spring.partner[2]}});
  }
  level.couplings.spring.resize(level.other.size());
  const auto spring_at = [&](std::size_t node, std::size_t e) {
    return stage.pattern[node] + static_cast<std::uint32_t>(e - at(stage.start[node]));
  };
  for (std::size_t node = 0; node < level.node_count; ++node) {
    for (std::size_t e = at(stage.start[node]); e < at(stage.start[node + 1]); ++e) {
      const std::size_t other = at(stage.other[e]);
      if (node < other) {
        const auto begin = stage.other.begin() + stage.start[other];
        const auto end = stage.other.begin() + stage.start[other + 1];
        const auto back = std::find(begin, end, static_cast<std::int32_t>(node));
        level.couplings.spring[e] = spring_at(node, e);
        level.couplings.spring[static_cast<std::size_t>(back - stage.other.begin())] =
            spring_at(node, e);
      }
    }
  }
}

template <>
void Hierarchy<float>::clear_anchors(Level<float>& level, std::size_t free_type_count) const {
  level.inverse.resize(free_type_count);
  level.couplings.diagonal.resize(free_type_count);
}

template <>
void Hierarchy<double>::clear_anchors(Level<double>& level, std::size_t free_type_count) const {
  level.inverse.resize(free_type_count);
  level.couplings.anchors.clear();
  level.couplings.free_type_count = free_type_count;
}

template <>
void Hierarchy<float>::add_anchored_type(Level<float>& level, const HeldNode& node) const {
  level.inverse.push_back(block_of<float>(inverse_of(node.sum)));
  level.couplings.diagonal.push_back(block_of<float>(node.sum));
}

template <>
void Hierarchy<double>::add_anchored_type(Level<double>& level, const HeldNode& node) const {
  level.inverse.push_back(block_of<double>(inverse_of(node.sum)));
  level.couplings.anchors.push_back(block_of<double>(node.anchor_sum));
}

template <class Real>
void Hierarchy<Real>::add_level(const Stage& stage, std::vector<std::size_t> colour_start) {
  Level<Real>& level = levels_.emplace_back();
  level.node_count = stage.order.size();
  level.colour_start = std::move(colour_start);
  level.start = stage.start;
  level.other = stage.other;
  couple(stage, level);
  level.type.resize(level.node_count);
  std::unordered_map<std::uint32_t, std::uint32_t> type_of_pattern;
  for (std::size_t node = 0; node < level.node_count; ++node) {
    const auto [found, is_new] = type_of_pattern.try_emplace(
        stage.pattern[node], static_cast<std::uint32_t>(type_of_pattern.size()));
    level.type[node] = found->second;
  }
  std::vector<Mat> sums(type_of_pattern.size());
  std::vector<bool> is_known(sums.size());
  for (std::size_t node = 0; node < level.node_count; ++node) {
    if (!is_known[level.type[node]]) {
      is_known[level.type[node]] = true;
      sums[level.type[node]] = spring_sum(stage, node);
    }
  }
  for (const Mat& sum : sums) {
    Mat inverse;
    // A pattern that only anchored nodes have may be singular alone; its inverse is not used.
    level.inverse.push_back(invert(sum, inverse) ? block_of<Real>(inverse) : Block<Real>{});
    if constexpr (std::is_same_v<Real, float>) {
      level.couplings.diagonal.push_back(block_of<float>(sum));
    }
  }
  fill_vectors(level);
  level.first.assign(level.node_count + 1, {});
  level.first_image.assign(level.node_count + 1, {});
}

/// Takes note of the nodes of the newest level that have anchors.
template <class Real>
typename Hierarchy<Real>::Held Hierarchy<Real>::held_nodes(
    const Stage& stage, const std::vector<Anchor>& anchors) const {
  Held held;
  held.free_type_count = levels_.back().inverse.size();
  for (const Anchor& anchor : anchors) {
    if (held.nodes.empty() || held.nodes.back().node != at(anchor.node)) {
      held.nodes.push_back(
          {.node = at(anchor.node), .spring_sum = spring_sum(stage, at(anchor.node))});
    }
  }
  return held;
}

/// K_pp of the nodes that have anchors.
template <class Real>
void Hierarchy<Real>::set_anchors(std::size_t depth, const std::vector<Anchor>& anchors) {
  Level<Real>& level = levels_[depth];
  Held& held = held_[depth - 1];
  clear_anchors(level, held.free_type_count);
  BlockPool<Real> pool;
  auto anchor = anchors.begin();
  for (HeldNode& node : held.nodes) {
    node.anchor_sum = {};
    for (; anchor != anchors.end() && at(anchor->node) == node.node; ++anchor) {
      base::add_to(node.anchor_sum, anchor->stiffness);
    }
    node.sum = node.spring_sum;
    base::add_to(node.sum, node.anchor_sum);
    // Only K_pp counts in single precision; in double, what is anchored must be known by itself.
    const std::size_t type = std::is_same_v<Real, float>
                                 ? held.free_type_count + pool.insert(block_of<Real>(node.sum))
                                 : level.inverse.size();
    level.type[node.node] = static_cast<std::uint32_t>(type);
    if (type == level.inverse.size()) {
      add_anchored_type(level, node);
    }
  }
}

template <class Real>
bool Hierarchy<Real>::factor_coarsest() {
  for (const HeldNode& node : held_.back().nodes) {
    coarsest_->set_diagonal(node.node, node.sum);
  }
  return coarsest_->factor();
}

template <class Real>
void Hierarchy<Real>::update_contact() {
  std::vector<Anchor> anchors = finest_anchors(network_, material_, ground_);
  for (const Anchor& anchor : anchors) {
    set_type(at(anchor.node));
  }
  point_at_lattice();
  for (std::size_t depth = 1; depth < levels_.size(); ++depth) {
    anchors = coarse_anchors(anchors, levels_[depth - 1].seat);
    set_anchors(depth, anchors);
  }
  if (coarsest_ && !factor_coarsest()) {
    coarsest_.reset();
  }
}

/// If its shape allows, or it is small.
template <class Real>
void Hierarchy<Real>::try_to_factor(const Stage& stage) {
  const std::size_t count = stage.order.size();
  const bool is_small = count <= kCoarsestCount;
  const bool is_thin = stage.other.size() <= kThinDegree * count;
  if (!is_small && is_thin && count > kChainMax<Real>) {
    is_too_slender_ = true;
    return;
  }
  if (is_small || (is_thin && count < network_.node_count / 4)) {
    coarsest_ = unheld_matrix(stage, is_small ? count * count : 2 * count);
    if (coarsest_ && !factor_coarsest()) {
      coarsest_.reset();
    }
  }
}

template <class Real>
Hierarchy<Real>::Hierarchy(const Network& network, const model::Material& material, Team& team,
                           GroundStiffness ground)
    : network_(network), material_(material), ground_(std::move(ground)) {
  make_lattice();
  Stage stage;
  fill_stage(team, stage);
  std::vector<Anchor> anchors = finest_anchors(network_, material_, ground_);
  while (!coarsest_ && (levels_.size() == 1 || stage.order.size() > kCoarsestCount)) {
    Stage coarse;
    std::vector<std::size_t> colour_start;
    if (!coarsen(stage, levels_.back(), team, coarse, colour_start)) {
      break;
    }
    stage = std::move(coarse);
    anchors = coarse_anchors(anchors, levels_.back().seat);
    add_level(stage, std::move(colour_start));
    held_.push_back(held_nodes(stage, anchors));
    set_anchors(levels_.size() - 1, anchors);
    try_to_factor(stage);
  }
}

template class Hierarchy<float>;
template class Hierarchy<double>;

}  // namespace holdfast::solver
