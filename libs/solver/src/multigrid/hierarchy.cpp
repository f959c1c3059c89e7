// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "hierarchy.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <unordered_map>

#include "../block_kernels.hpp"
#include "holdfast/base/check.hpp"

namespace holdfast::solver {
namespace {

using base::Direction;
using Point = std::array<double, 3>;

constexpr std::size_t kRow = kBeamLengthMax + 1;
constexpr std::uint8_t kNoColour = 255;

std::size_t at(std::int32_t index) { return static_cast<std::size_t>(index); }

/// Which displacement bends with which on a beam along an axis; see kernel_loops.hpp.
constexpr std::size_t kSwap[3][6] = {{0, 5, 4, 3, 2, 1}, {5, 1, 3, 2, 4, 0}, {4, 3, 2, 1, 0, 5}};

Block single(const Mat& matrix) {
  Block block;
  for (int column = 0; column < 6; ++column) {
    for (int row = 0; row < 6; ++row) {
      block.column[column][row] = static_cast<float>(matrix.at(row, column));
    }
  }
  return block;
}

Mat inverse_of(const Mat& matrix) {
  Mat inverse;
  HOLDFAST_CHECK(invert(matrix, inverse));
  return inverse;
}

/// S T(a), T(a) [u, t] = [u + t x a, t]: the columns of t gain those of u times -[a]x.
Mat times_carry(Mat s, const Point& a) {
  for (int row = 0; row < 6; ++row) {
    const double x = s.at(row, 0);
    const double y = s.at(row, 1);
    const double z = s.at(row, 2);
    // (t x a) = [ty az - tz ay, tz ax - tx az, tx ay - ty ax]
    s.at(row, 3) += z * a[1] - y * a[2];
    s.at(row, 4) += x * a[2] - z * a[0];
    s.at(row, 5) += y * a[0] - x * a[1];
  }
  return s;
}

/// T(a)^T S T(a): a spring at x seen from the point x - a.
Mat carried(const Mat& s, const Point& a) {
  return times_carry(transpose(times_carry(transpose(s), a)), a);
}

Mat scaled(Mat matrix, double factor) {
  for (double& value : matrix.values) {
    value *= factor;
  }
  return matrix;
}

/// One spring of a node, while levels are built.
struct Spring {
  std::int32_t other = 0;
  std::uint8_t direction = 0;
  float length = 0;  ///< mm
  Mat stiffness;     ///< At the node.
};

/// A level while the next one is made from it, nodes in the level's own order.
struct Stage {
  std::vector<std::int32_t> order;  ///< Along the Morton curve.
  std::vector<std::uint64_t> key;   ///< By node: Morton key of its cell.
  std::vector<Point> place;         ///< mm
  std::vector<std::int32_t> start;
  std::vector<Spring> springs;      ///< Not for the finest level: see `network`.
  std::vector<Anchor> anchors;      ///< Ascending by node.
  const Network* network = nullptr;
  std::array<std::vector<Mat>, 6> k11;  ///< By direction and length, finest level.
  double pitch = 0;

  /// Calls f(other, direction, length, stiffness) for every spring of a node.
  template <class F>
  void for_springs(std::size_t node, const F& f) const {
    if (network == nullptr) {
      for (std::size_t e = at(start[node]); e < at(start[node + 1]); ++e) {
        const Spring& spring = springs[e];
        f(spring.other, spring.direction, static_cast<double>(spring.length), spring.stiffness);
      }
      return;
    }
    for (std::size_t d = 0; d < 6; ++d) {
      const std::int32_t other = network->other[node][d];
      if (at(other) < network->node_count) {
        const std::size_t length = network->kind[node][d];
        f(other, static_cast<std::uint8_t>(d), pitch * static_cast<double>(length),
          k11[d][length]);
      }
    }
  }
};

double along(const Point& a, const Point& b, std::size_t direction) {
  const double step = b[direction / 2] - a[direction / 2];
  return direction % 2 == 0 ? step : -step;
}

/// Distance from the end of a spring back to the centre of the cluster that it belongs to.
double behind(const Point& centre, const Point& node, std::size_t direction) {
  return std::max(0.0, along(centre, node, direction));
}

Point difference(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }

/// Connected parts within cells whose keys agree but for the last `shift` bits. Returns how many;
/// parts are numbered along the Morton curve.
std::size_t find_clusters(const Stage& stage, unsigned shift, std::vector<std::int32_t>& cluster) {
  cluster.assign(stage.order.size(), -1);
  std::int32_t count = 0;
  std::vector<std::int32_t> open;
  for (const std::int32_t first : stage.order) {
    if (cluster[at(first)] >= 0) {
      continue;
    }
    const std::uint64_t cell = stage.key[at(first)] >> shift;
    cluster[at(first)] = count;
    open.assign(1, first);
    while (!open.empty()) {
      const std::size_t node = at(open.back());
      open.pop_back();
      const auto take = [&](std::int32_t other) {
        if (cluster[at(other)] < 0 && stage.key[at(other)] >> shift == cell) {
          cluster[at(other)] = count;
          open.push_back(other);
        }
      };
      if (stage.network != nullptr) {
        for (const std::int32_t other : stage.network->other[node]) {
          if (at(other) < stage.network->node_count) {
            take(other);
          }
        }
      } else {
        for (std::size_t e = at(stage.start[node]); e < at(stage.start[node + 1]); ++e) {
          take(stage.springs[e].other);
        }
      }
    }
    ++count;
  }
  return static_cast<std::size_t>(count);
}

std::size_t count_cells(const Stage& stage, unsigned shift) {
  std::size_t count = 0;
  std::uint64_t last = ~std::uint64_t{0};
  for (const std::int32_t node : stage.order) {
    const std::uint64_t cell = stage.key[at(node)] >> shift;
    count += cell != last ? 1 : 0;
    last = cell;
  }
  return count;
}

/// Makes the next stage and the way to it.
class Coarsening {
 public:
  Coarsening(const Stage& fine, Level& level, Team& team, double correction)
      : fine_(fine), level_(level), team_(team), correction_(correction) {}

  /// Returns false if no larger cells make the level much smaller.
  bool run(Stage& coarse, std::vector<std::size_t>& colour_start) {
    unsigned shift = 3;
    const std::size_t count = fine_.order.size();
    while (shift < 63 && 5 * count_cells(fine_, shift) > 2 * count) {
      shift += 3;
    }
    const std::size_t cluster_count = find_clusters(fine_, shift, cluster_);
    if (10 * cluster_count > 9 * count) {
      return false;
    }
    gather_members(cluster_count);
    colour(cluster_count, colour_start);
    renumber(cluster_count, coarse, shift);
    place_centres(coarse);
    seat_members(coarse);
    make_springs(coarse);
    make_anchors(coarse);
    return true;
  }

 private:
  /// Members by cluster, clusters as yet along the Morton curve.
  void gather_members(std::size_t cluster_count) {
    std::vector<std::int32_t> start(cluster_count + 1, 0);
    for (const std::int32_t c : cluster_) {
      ++start[at(c) + 1];
    }
    for (std::size_t c = 0; c < cluster_count; ++c) {
      start[c + 1] += start[c];
    }
    member_.resize(cluster_.size());
    member_start_ = start;
    for (const std::int32_t node : fine_.order) {
      member_[at(start[at(cluster_[at(node)])]++)] = node;
    }
  }

  template <class F>
  void for_members(std::size_t cluster, const F& f) const {
    for (std::size_t i = at(member_start_[cluster]); i < at(member_start_[cluster + 1]); ++i) {
      f(at(member_[i]));
    }
  }

  void for_neighbours(std::size_t node, const auto& f) const {
    if (fine_.network != nullptr) {
      for (const std::int32_t other : fine_.network->other[node]) {
        if (at(other) < fine_.network->node_count) {
          f(other);
        }
      }
      return;
    }
    for (std::size_t e = at(fine_.start[node]); e < at(fine_.start[node + 1]); ++e) {
      f(fine_.springs[e].other);
    }
  }

  void colour(std::size_t cluster_count, std::vector<std::size_t>& colour_start) {
    std::vector<std::uint8_t> colours(cluster_count, kNoColour);
    std::array<std::size_t, 64> count{};
    for (std::size_t c = 0; c < cluster_count; ++c) {
      std::uint64_t taken = 0;
      for_members(c, [&](std::size_t node) {
        for_neighbours(node, [&](std::int32_t other) {
          const std::uint8_t used = colours[at(cluster_[at(other)])];
          if (used != kNoColour && at(cluster_[at(other)]) != c) {
            taken |= std::uint64_t{1} << used;
          }
        });
      });
      // With 63 colours taken the next one is shared: the sweep is then not exact, still fixed.
      colours[c] = static_cast<std::uint8_t>(std::min(std::countr_one(taken), 63));
      ++count[colours[c]];
    }
    colour_start = {0};
    std::array<std::int32_t, 64> next{};
    for (std::size_t k = 0; k < 64; ++k) {
      next[k] = static_cast<std::int32_t>(colour_start.back());
      if (count[k] > 0) {
        colour_start.push_back(colour_start.back() + count[k]);
      }
    }
    final_.resize(cluster_count);
    for (std::size_t c = 0; c < cluster_count; ++c) {
      final_[c] = next[colours[c]]++;
    }
  }

  /// From the order along the curve to the order by colours.
  void renumber(std::size_t cluster_count, Stage& coarse, unsigned shift) {
    coarse.order = final_;
    coarse.key.resize(cluster_count);
    std::vector<std::int32_t> curve(cluster_count);
    for (std::size_t c = 0; c < cluster_count; ++c) {
      curve[at(final_[c])] = static_cast<std::int32_t>(c);
      coarse.key[at(final_[c])] = fine_.key[at(member_[at(member_start_[c])])] >> shift;
    }
    level_.member.reserve(member_.size());
    level_.member_start = {0};
    for (const std::int32_t c : curve) {
      for_members(at(c), [&](std::size_t node) {
        level_.member.push_back(static_cast<std::int32_t>(node));
      });
      level_.member_start.push_back(static_cast<std::int32_t>(level_.member.size()));
    }
    for (std::int32_t& c : cluster_) {
      c = final_[at(c)];
    }
    member_ = level_.member;
    member_start_ = level_.member_start;
  }

  void place_centres(Stage& coarse) const {
    coarse.place.resize(coarse.order.size());
    for (std::size_t c = 0; c < coarse.place.size(); ++c) {
      Point sum{};
      double count = 0;
      for_members(c, [&](std::size_t node) {
        for (std::size_t i = 0; i < 3; ++i) {
          sum[i] += fine_.place[node][i];
        }
        ++count;
      });
      coarse.place[c] = {sum[0] / count, sum[1] / count, sum[2] / count};
    }
  }

  void seat_members(const Stage& coarse) {
    level_.seat.resize(fine_.order.size());
    for (std::size_t node = 0; node < level_.seat.size(); ++node) {
      const Point offset = difference(fine_.place[node], coarse.place[at(cluster_[node])]);
      level_.seat[node] = {.offset = {static_cast<float>(offset[0]), static_cast<float>(offset[1]),
                                      static_cast<float>(offset[2])},
                           .cluster = cluster_[node]};
    }
  }

  /// The springs of one cluster, its neighbours in the order in which they are met.
  void add_springs(std::size_t c, const Stage& coarse, std::vector<Spring>& springs) const {
    springs.clear();
    std::vector<double>& weight = weight_scratch();
    weight.clear();
    for_members(c, [&](std::size_t node) {
      const Point offset = difference(fine_.place[node], coarse.place[c]);
      fine_.for_springs(node, [&](std::int32_t other, std::uint8_t direction, double length,
                                  const Mat& stiffness) {
        const std::int32_t to = cluster_[at(other)];
        if (at(to) == c) {
          return;
        }
        std::size_t i = 0;
        while (i < springs.size() && springs[i].other != to) {
          ++i;
        }
        if (i == springs.size()) {
          springs.push_back({.other = to, .direction = direction});
          weight.push_back(0);
        }
        const double reach = length + behind(coarse.place[c], fine_.place[node], direction) +
                             behind(coarse.place[at(to)], fine_.place[at(other)], direction ^ 1U);
        const double factor = correction_ * length / reach;
        base::add_to(springs[i].stiffness, scaled(carried(stiffness, offset), factor));
        springs[i].length += static_cast<float>(reach);
        weight[i] += 1;
      });
    });
    for (std::size_t i = 0; i < springs.size(); ++i) {
      springs[i].length /= static_cast<float>(weight[i]);
    }
  }

  static std::vector<double>& weight_scratch() {
    static thread_local std::vector<double> scratch;
    return scratch;
  }

  void make_springs(Stage& coarse) {
    const std::size_t count = coarse.order.size();
    const std::size_t chunk_count = (count + Team::kChunk - 1) / Team::kChunk;
    std::vector<std::vector<Spring>> parts(chunk_count);
    std::vector<std::int32_t> degree(count);
    team_.share(0, count, [&](std::size_t begin, std::size_t end) {
      std::vector<Spring> springs;
      for (std::size_t c = begin; c < end; ++c) {
        add_springs(c, coarse, springs);
        degree[c] = static_cast<std::int32_t>(springs.size());
        std::vector<Spring>& part = parts[c / Team::kChunk];
        part.insert(part.end(), springs.begin(), springs.end());
      }
    });
    coarse.start.assign(count + 1, 0);
    for (std::size_t c = 0; c < count; ++c) {
      coarse.start[c + 1] = coarse.start[c] + degree[c];
    }
    coarse.springs.reserve(at(coarse.start[count]));
    for (std::vector<Spring>& part : parts) {
      coarse.springs.insert(coarse.springs.end(), part.begin(), part.end());
      part = {};
    }
  }

  void make_anchors(Stage& coarse) const {
    std::vector<Anchor> anchors;
    for (const Anchor& anchor : fine_.anchors) {
      const std::size_t node = at(anchor.node);
      const std::size_t c = at(cluster_[node]);
      const double reach =
          anchor.length + behind(coarse.place[c], fine_.place[node], anchor.direction);
      anchors.push_back(
          {.node = cluster_[node],
           .direction = anchor.direction,
           .length = reach,
           .stiffness = scaled(carried(anchor.stiffness,
                                       difference(fine_.place[node], coarse.place[c])),
                               correction_ * anchor.length / reach)});
    }
    std::ranges::stable_sort(anchors, {}, &Anchor::node);
    for (const Anchor& anchor : anchors) {
      std::vector<Anchor>& kept = coarse.anchors;
      if (!kept.empty() && kept.back().node == anchor.node &&
          kept.back().direction == anchor.direction) {
        base::add_to(kept.back().stiffness, anchor.stiffness);
      } else {
        kept.push_back(anchor);
      }
    }
  }

  const Stage& fine_;
  Level& level_;
  Team& team_;
  double correction_;
  std::vector<std::int32_t> cluster_;
  std::vector<std::int32_t> member_;
  std::vector<std::int32_t> member_start_;
  std::vector<std::int32_t> final_;
};

/// K_pp of every node of a coarse stage.
std::vector<Mat> diagonals(const Stage& stage) {
  std::vector<Mat> sums(stage.order.size());
  for (std::size_t node = 0; node < sums.size(); ++node) {
    stage.for_springs(node, [&](std::int32_t, std::uint8_t, double, const Mat& stiffness) {
      base::add_to(sums[node], stiffness);
    });
  }
  for (const Anchor& anchor : stage.anchors) {
    base::add_to(sums[at(anchor.node)], anchor.stiffness);
  }
  return sums;
}

Mat coupling(const Stage& stage, std::size_t node, const Spring& spring) {
  return scaled(times_carry(spring.stiffness,
                            difference(stage.place[node], stage.place[at(spring.other)])),
                -1);
}

/// Blocks in single precision for the sweeps.
void fill_level(const Stage& stage, Level& level) {
  level.node_count = stage.order.size();
  level.start = stage.start;
  level.other.reserve(stage.springs.size());
  level.block.reserve(stage.springs.size());
  for (std::size_t node = 0; node < level.node_count; ++node) {
    for (std::size_t e = at(stage.start[node]); e < at(stage.start[node + 1]); ++e) {
      level.other.push_back(stage.springs[e].other);
      level.block.push_back(level.blocks.insert(single(coupling(stage, node, stage.springs[e]))));
    }
  }
  level.blocks.close();
  BlockPool pool;
  level.type.resize(level.node_count);
  const std::vector<Mat> sums = diagonals(stage);
  for (std::size_t node = 0; node < level.node_count; ++node) {
    const std::uint32_t type = pool.insert(single(sums[node]));
    level.type[node] = type;
    if (type == level.diagonal.size()) {
      level.diagonal.push_back(single(sums[node]));
      level.inverse.push_back(single(inverse_of(sums[node])));
    }
  }
}

/// The whole level as a sparse matrix in double precision.
std::optional<BlockLu> factorize(const Stage& stage, std::size_t block_count_max) {
  std::vector<Edge> edges;
  std::vector<Mat> blocks;
  for (std::size_t node = 0; node < stage.order.size(); ++node) {
    for (std::size_t e = at(stage.start[node]); e < at(stage.start[node + 1]); ++e) {
      const Spring& spring = stage.springs[e];
      if (at(spring.other) > node) {
        edges.push_back({static_cast<std::int32_t>(node), spring.other});
        blocks.push_back(coupling(stage, node, spring));
      }
    }
  }
  BlockLu lu(stage.order.size(), edges, block_count_max);
  if (lu.is_too_large()) {
    return std::nullopt;
  }
  for (std::size_t e = 0; e < edges.size(); ++e) {
    lu.set_edge(e, blocks[e]);
  }
  const std::vector<Mat> sums = diagonals(stage);
  for (std::size_t node = 0; node < sums.size(); ++node) {
    lu.set_diagonal(node, sums[node]);
  }
  HOLDFAST_CHECK(lu.factor());
  return lu;
}

void fill_vectors(Level& level) {
  level.r.assign(level.node_count + 1, {});
  level.z.assign(level.node_count + 1, {});
}

}  // namespace

ClusterView Level::view() const {
  return {.start = start.data(),
          .other = other.data(),
          .block = block.data(),
          .blocks = blocks.data(),
          .type = type.data(),
          .diagonal = diagonal.data(),
          .inverse = inverse.data()};
}

TransferView Level::transfer() const {
  return {.seat = seat.data(), .start = member_start.data(), .member = member.data()};
}

void Hierarchy::make_lattice(const Network& network, const model::Material& material) {
  beams_.resize(6 * kRow);
  beams_double_.resize(6 * kRow);
  std::array<std::vector<Mat>, 6> k11;
  for (std::size_t d = 0; d < 6; ++d) {
    k11[d].resize(kRow);
    for (int length = 1; length <= kBeamLengthMax; ++length) {
      const auto beam = long_beam(material, length);
      const auto l = static_cast<std::size_t>(length);
      k11[d][l] = mechanics::block_11(beam, static_cast<Direction>(d));
      const Mat k12 = mechanics::block_12(beam, static_cast<Direction>(d));
      BeamRowDouble& row = beams_double_[d * kRow + l];
      for (std::size_t i = 0; i < 6; ++i) {
        const std::size_t j = kSwap[d / 2][i];
        row.direct[i] = k12.at(static_cast<int>(i), static_cast<int>(i));
        row.crossed[i] = i == j ? 0 : k12.at(static_cast<int>(i), static_cast<int>(j));
        beams_[d * kRow + l].direct.v[i] = static_cast<float>(row.direct[i]);
        beams_[d * kRow + l].crossed.v[i] = static_cast<float>(row.crossed[i]);
      }
      if (!network.has_long_beams) {
        break;
      }
    }
  }
  Level& level = levels_.front();
  level.node_count = network.node_count;
  level.colour_start = network.colour_start;
  level.type.resize(network.node_count);
  std::unordered_map<std::uint64_t, std::uint32_t> types;
  std::uint64_t last = 0;
  std::uint32_t last_type = 0;
  for (std::size_t node = 0; node < network.node_count; ++node) {
    const auto kind = std::bit_cast<std::uint64_t>(network.kind[node]);
    if (kind != last || node == 0) {
      const auto [found, is_new] = types.emplace(kind, static_cast<std::uint32_t>(types.size()));
      last = kind;
      last_type = found->second;
      if (is_new) {
        Mat sum;
        for (std::size_t d = 0; d < 6; ++d) {
          base::add_to(sum, k11[d][network.kind[node][d]]);
        }
        level.diagonal.push_back(single(sum));
        level.inverse.push_back(single(inverse_of(sum)));
        BlockDouble wide;
        for (int column = 0; column < 6; ++column) {
          for (int row = 0; row < 6; ++row) {
            wide.column[column][row] = sum.at(row, column);
          }
        }
        diagonal_double_.push_back(wide);
      }
    }
    level.type[node] = last_type;
  }
  lattice_ = {.other = network.other.data(),
              .kind = network.has_long_beams ? network.kind.data() : nullptr,
              .type = level.type.data(),
              .beams = beams_.data(),
              .diagonal = level.diagonal.data(),
              .inverse = level.inverse.data(),
              .beams_double = beams_double_.data(),
              .diagonal_double = diagonal_double_.data()};
}

Hierarchy::Hierarchy(const Network& network, const model::Material& material, Team& team,
                     const HierarchyOptions& options) {
  levels_.emplace_back();
  make_lattice(network, material);
  Stage stage;
  stage.network = &network;
  stage.pitch = material.pitch_mm;
  stage.order = network.order;
  stage.key.resize(network.node_count);
  stage.place.resize(network.node_count);
  for (std::size_t i = 0; i < network.node_count; ++i) {
    stage.key[at(network.order[i])] = network.key[i];
  }
  for (std::size_t d = 0; d < 6; ++d) {
    stage.k11[d].resize(kRow);
    for (int length = 1; length <= kBeamLengthMax; ++length) {
      stage.k11[d][static_cast<std::size_t>(length)] =
          mechanics::block_11(long_beam(material, length), static_cast<Direction>(d));
    }
  }
  for (std::size_t node = 0; node < network.node_count; ++node) {
    // Keys interleave x, y, z; positions are taken from them.
    std::array<std::uint64_t, 3> cell{};
    for (unsigned bit = 0; bit < 21; ++bit) {
      for (unsigned axis = 0; axis < 3; ++axis) {
        cell[axis] |= ((stage.key[node] >> (3 * bit + axis)) & 1U) << bit;
      }
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      stage.place[node][axis] = material.pitch_mm * static_cast<double>(cell[axis]);
    }
    for (std::size_t d = 0; d < 6; ++d) {
      const std::size_t length = network.kind[node][d];
      if (length > 0 && at(network.other[node][d]) == network.node_count) {
        stage.anchors.push_back({.node = static_cast<std::int32_t>(node),
                                 .direction = static_cast<std::uint8_t>(d),
                                 .length = material.pitch_mm * static_cast<double>(length),
                                 .stiffness = stage.k11[d][length]});
      }
    }
  }
  fill_vectors(levels_.front());
  while (true) {
    Stage coarse;
    std::vector<std::size_t> colour_start;
    Coarsening coarsening(stage, levels_.back(), team, options.correction);
    if (!coarsening.run(coarse, colour_start)) {
      break;
    }
    stage = std::move(coarse);
    levels_.emplace_back();
    Level& level = levels_.back();
    level.colour_start = colour_start;
    fill_level(stage, level);
    fill_vectors(level);
    const std::size_t count = level.node_count;
    if (count <= options.coarsest_count || count < network.node_count / 4) {
      coarsest_ = factorize(stage, count <= options.coarsest_count ? count * count : 2 * count);
      if (coarsest_) {
        break;
      }
    }
  }
}

std::size_t Hierarchy::bytes() const {
  std::size_t sum = 0;
  for (const Level& level : levels_) {
    sum += level.start.capacity() * 4 + level.other.capacity() * 4 + level.block.capacity() * 4 +
           level.blocks.size() * sizeof(Block) + level.type.capacity() * 4 +
           (level.diagonal.capacity() + level.inverse.capacity()) * sizeof(Block) +
           level.seat.capacity() * sizeof(Seat) + level.member.capacity() * 4 +
           level.member_start.capacity() * 4 +
           (level.r.capacity() + level.z.capacity()) * sizeof(Six);
  }
  return sum;
}

}  // namespace holdfast::solver
