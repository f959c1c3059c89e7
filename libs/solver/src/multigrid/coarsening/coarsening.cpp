// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "multigrid/coarsening/coarsening.hpp"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <map>
#include <span>
#include <type_traits>
#include <unordered_map>
#include <utility>

#include "holdfast/base/algebra.hpp"
#include "multigrid/coarsening/cluster_colours.hpp"
#include "multigrid/coarsening/gathered_graph.hpp"
#include "multigrid/coarsening/slivers.hpp"
#include "multigrid/coarsening/weak_springs.hpp"

namespace holdfast::solver {
namespace {

using base::at;

/// Directions whose mean is shorter than this lead everywhere.
constexpr double kClear = 0.1;

/// Coordinates that are equal for all clusters that look alike: differences lose their last bits.
/// In double precision they have none to lose: centres lie on a grid.
template <class Real>
Point rounded(const Point& point) {
  return {static_cast<double>(static_cast<Real>(point[0])),
          static_cast<double>(static_cast<Real>(point[1])),
          static_cast<double>(static_cast<Real>(point[2]))};
}

/// Where a cluster's motion is meant; any point near its middle will do. In double precision one of
/// a grid, so that differences are exact and turning everything deforms nothing.
template <class Real>
Point centre(Point mean) {
  if constexpr (std::is_same_v<Real, double>) {
    constexpr double kPerMm = 1024;
    for (double& x : mean) {
      x = std::nearbyint(x * kPerMm) / kPerMm;
    }
  }
  return mean;
}

/// A spring of a member that leads out of the cluster: what the cluster's spring depends on.
struct Part {
  std::uint32_t spring = 0;  ///< Index into the fine level's springs.
  std::uint32_t target = 0;  ///< Which of the cluster's neighbours, in the order they are met.
  bool is_weak = false;
  Point offset = {};      ///< From the cluster's centre to the member.
  Point far_offset = {};  ///< From the partner's cluster's centre to the partner.
  Point partner = {};     ///< From the cluster's centre to that of the partner's cluster.
};

/// Two words that stand for a cluster's parts; equal by chance once in 2^100 clusters.
struct Signature {
  std::uint64_t a = 0x243f6a8885a308d3U;
  std::uint64_t b = 0x13198a2e03707344U;

  void add(std::uint64_t word) {
    a = (a ^ word) * 0x9e3779b97f4a7c15U;
    a ^= a >> 32U;
    b = (b + word) * 0xbf58476d1ce4e5b9U;
    b ^= b >> 29U;
  }

  /// Two coordinates that Real holds.
  template <class Real>
  void add(double x, double y) {
    if constexpr (std::is_same_v<Real, double>) {
      add(std::bit_cast<std::uint64_t>(x + 0.0));
      add(std::bit_cast<std::uint64_t>(y + 0.0));
      return;
    }
    add(std::uint64_t{std::bit_cast<std::uint32_t>(static_cast<float>(x + 0.0))} << 32U |
        std::bit_cast<std::uint32_t>(static_cast<float>(y + 0.0)));
  }

  friend bool operator==(const Signature&, const Signature&) = default;
};

struct SignatureHash {
  std::size_t operator()(const Signature& signature) const { return signature.a; }
};

Point opposite(const Point& point) { return {-point[0], -point[1], -point[2]}; }

/// The axis along which most of a cluster's connections with another lead. United slivers may meet
/// around a corner, and both ends must find the same axis.
Point main_axis(const Point& along, const Point& partner) {
  const auto axis = static_cast<std::size_t>(std::ranges::max_element(along) - along.begin());
  Point direction{};
  direction[axis] = partner[axis] < 0 ? -1 : 1;
  return direction;
}

/// The mean of the directions in which a cluster's connections with another lead, of length one;
/// that of the other cluster if they lead everywhere. `sum` and `weight` are sums of theirs.
Point mean_direction(const Point& sum, double weight, const Point& partner) {
  const bool is_clear = dot(sum, sum) > kClear * kClear * weight * weight;
  const Point& direction = is_clear ? sum : partner;
  const double norm = std::sqrt(dot(direction, direction));
  return {direction[0] / norm, direction[1] / norm, direction[2] / norm};
}

template <class Real>
class Coarsening {
 public:
  Coarsening(SpringGraph& fine, Level<Real>& level, Team& team, SpringGraph& coarse)
      : fine_(fine), level_(level), team_(team), coarse_(coarse) {}

  bool run(std::vector<std::size_t>& colour_start) {
    if (is_gathered_as_it_is()) {
      join_none();
      finish(0, colour_start);
      return true;
    }
    unsigned shift = 3;
    const std::size_t count = host::total(fine_.ranks, fine_.own_count());
    while (shift < 63 && 5 * host::total(fine_.ranks, count_cells(shift)) > 2 * count) {
      shift += 3;
    }
    if constexpr (std::is_same_v<Real, float>) {
      is_weak_ = weak_springs(fine_, team_, *level_.halo);
    }
    find_clusters(shift);
    coarse_.shift = fine_.shift + shift;
    coarse_.is_along_axes = fine_.is_along_axes;
    if (!fine_.box.empty()) {
      cluster_count_ = unite_slivers(fine_, coarse_.shift, cluster_, cluster_count_, coarse_.box);
    }
    if (!has_merged() && host::any(fine_.ranks, !is_weak_.empty())) {
      is_weak_.clear();
      find_clusters(shift);
    }
    if (!has_merged()) {
      return false;
    }
    finish(shift, colour_start);
    return true;
  }

 private:
  /// Makes the level of the clusters that nodes have joined.
  void finish(unsigned shift, std::vector<std::size_t>& colour_start) {
    gather_members();
    colour(colour_start);
    renumber(shift);
    place_centres();
    follow_copies();
    seat_members();
    // Springs take the most memory, and need neither.
    fine_.place = std::vector<Point>();
    fine_.key = std::vector<std::uint64_t>();
    make_springs();
    leave_alone();
  }

  /// Whether a tenth of the nodes is gone, enough for a level of its own.
  bool has_merged() const {
    return 10 * host::total(fine_.ranks, cluster_count_) <=
           9 * host::total(fine_.ranks, fine_.own_count());
  }

  /// Few nodes in parts, which clusters within ranks would make a poor level of: the next level is
  /// the same, and whole.
  bool is_gathered_as_it_is() const {
    return fine_.is_part() && host::total(fine_.ranks, fine_.own_count()) <= kGatheredCount;
  }

  void join_none() {
    cluster_.assign(fine_.order.size(), -1);
    std::int32_t count = 0;
    for (const std::int32_t node : own_order()) {
      cluster_[at(node)] = count++;
    }
    cluster_count_ = at(count);
    coarse_.shift = fine_.shift;
    coarse_.is_along_axes = fine_.is_along_axes;
    for (std::size_t i = 0; i < fine_.box.size() && i < cluster_count_; ++i) {
      coarse_.box.push_back(fine_.box[at(fine_.order[i])]);
    }
  }

  /// Nodes along the curve, without copies.
  std::span<const std::int32_t> own_order() const {
    return std::span(fine_.order).first(fine_.own_count());
  }

  std::size_t count_cells(unsigned shift) const {
    std::size_t count = 0;
    std::uint64_t last = ~std::uint64_t{0};
    for (const std::int32_t node : own_order()) {
      const std::uint64_t cell = fine_.key[at(node)] >> shift;
      count += cell != last ? 1 : 0;
      last = cell;
    }
    return count;
  }

  bool is_weak(std::size_t edge) const { return !is_weak_.empty() && is_weak_[edge] == 1; }

  /// Connected parts within cells whose keys agree but for the last `shift` bits, numbered along
  /// the Morton curve. Threads take stretches of it that end where cells do.
  void find_clusters(unsigned shift) {
    cluster_.assign(fine_.order.size(), -1);
    const std::vector<std::size_t> bounds = stretches(shift);
    std::vector<std::int32_t> counts(bounds.size() - 1);
    const auto stretch = [&](std::size_t i) {
      return own_order().subspan(bounds[i], bounds[i + 1] - bounds[i]);
    };
    team_.each(counts.size(), [&](std::size_t i) { counts[i] = join(shift, stretch(i)); });
    std::int32_t count = 0;
    for (std::int32_t& first : counts) {
      count += std::exchange(first, count);
    }
    team_.each(counts.size(), [&](std::size_t i) {
      for (const std::int32_t node : stretch(i)) {
        cluster_[at(node)] += counts[i];
      }
    });
    cluster_count_ = at(count);
  }

  /// Where stretches of the curve begin and end, between cells.
  std::vector<std::size_t> stretches(unsigned shift) const {
    constexpr std::size_t kLength = 1U << 14U;
    const auto order = own_order();
    const auto cell = [&](std::size_t i) { return fine_.key[at(order[i])] >> shift; };
    const std::size_t length = is_along_curve(shift) ? kLength : order.size();
    std::vector<std::size_t> bounds = {0};
    for (std::size_t i = length; i < order.size(); i += length) {
      while (i < order.size() && cell(i) == cell(i - 1)) {
        ++i;
      }
      if (i < order.size()) {
        bounds.push_back(i);
      }
    }
    bounds.push_back(order.size());
    return bounds;
  }

  /// Whether cells are stretches of the curve, as they are but where slivers of several were
  /// united.
  bool is_along_curve(unsigned shift) const {
    const auto order = own_order();
    const auto cell = [&](std::size_t i) { return fine_.key[at(order[i])] >> shift; };
    std::atomic<bool> is_so = true;
    team_.share(0, order.size(), [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = std::max<std::size_t>(begin, 1); i < end; ++i) {
        if (cell(i) < cell(i - 1)) {
          is_so.store(false, std::memory_order_relaxed);
        }
      }
    });
    return is_so;
  }

  /// Numbers the clusters of some nodes, all those of their cells, from 0 on, and says how many
  /// there are.
  std::int32_t join(unsigned shift, std::span<const std::int32_t> nodes) {
    std::vector<std::int32_t> open;
    std::int32_t count = 0;
    for (const std::int32_t first : nodes) {
      if (cluster_[at(first)] >= 0) {
        continue;
      }
      const std::uint64_t cell = fine_.key[at(first)] >> shift;
      cluster_[at(first)] = count;
      open.assign(is_alone(at(first)) ? 0 : 1, first);
      while (!open.empty()) {
        const std::size_t node = at(open.back());
        open.pop_back();
        for (std::size_t e = at(fine_.start[node]); e < at(fine_.start[node + 1]); ++e) {
          const std::int32_t other = fine_.other[e];
          // Of other cells' nodes another thread may be telling the cluster.
          if (!fine_.is_copy(other) && fine_.key[at(other)] >> shift == cell &&
              cluster_[at(other)] < 0 && !is_weak(e) && !is_alone(at(other))) {
            cluster_[at(other)] = count;
            open.push_back(other);
          }
        }
      }
      ++count;
    }
    return count;
  }

  bool is_alone(std::size_t node) const { return !fine_.is_alone.empty() && fine_.is_alone[node]; }

  /// Members by cluster, clusters as yet along the Morton curve.
  void gather_members() {
    std::vector<std::int32_t> next(cluster_count_ + 1, 0);
    for (const std::int32_t node : own_order()) {
      ++next[at(cluster_[at(node)]) + 1];
    }
    for (std::size_t c = 0; c < cluster_count_; ++c) {
      next[c + 1] += next[c];
    }
    member_start_ = next;
    member_.resize(fine_.own_count());
    for (const std::int32_t node : own_order()) {
      member_[at(next[at(cluster_[at(node)])]++)] = node;
    }
  }

  template <class F>
  void for_members(std::size_t cluster, const F& f) const {
    for (std::size_t i = at(member_start_[cluster]); i < at(member_start_[cluster + 1]); ++i) {
      f(at(member_[i]));
    }
  }

  void colour(std::vector<std::size_t>& colour_start) {
    const std::vector<std::uint8_t> colours =
        colour_clusters(fine_,
                        {.of_node = cluster_,
                         .member = member_,
                         .member_start = member_start_,
                         .shift = coarse_.shift - fine_.shift},
                        team_, *level_.halo);
    std::array<double, 64> count{};  // Whole numbers, which ranks add up.
    for (const std::uint8_t colour : colours) {
      ++count[colour];
    }
    const std::array<double, 64> everywhere = host::sum(fine_.ranks, count);
    colour_start = {0};
    std::array<std::int32_t, 64> next{};
    for (std::size_t k = 0; k < 64; ++k) {
      next[k] = static_cast<std::int32_t>(colour_start.back());
      if (everywhere[k] > 0) {  // All ranks have the same colours.
        colour_start.push_back(colour_start.back() + static_cast<std::size_t>(count[k]));
      }
    }
    final_.resize(cluster_count_);
    for (std::size_t c = 0; c < cluster_count_; ++c) {
      final_[c] = next[colours[c]]++;
    }
  }

  /// Changes from the order along the curve to the order by colours.
  void renumber(unsigned shift) {
    coarse_.order = final_;
    coarse_.key.resize(cluster_count_);
    std::vector<std::int32_t> curve(cluster_count_);
    for (std::size_t c = 0; c < cluster_count_; ++c) {
      curve[at(final_[c])] = static_cast<std::int32_t>(c);
      coarse_.key[at(final_[c])] = fine_.key[at(member_[at(member_start_[c])])] >> shift;
    }
    const std::vector<CellBox> box = coarse_.box;
    for (std::size_t c = 0; c < box.size(); ++c) {
      coarse_.box[at(final_[c])] = box[c];
    }
    std::vector<std::int32_t> member;
    std::vector<std::int32_t> member_start = {0};
    member.reserve(member_.size());
    member_start.reserve(cluster_count_ + 1);
    for (const std::int32_t c : curve) {
      for_members(at(c),
                  [&](std::size_t node) { member.push_back(static_cast<std::int32_t>(node)); });
      member_start.push_back(static_cast<std::int32_t>(member.size()));
    }
    for (const std::int32_t node : own_order()) {
      cluster_[at(node)] = final_[at(cluster_[at(node)])];
    }
    level_.member = std::exchange(member_, std::move(member));
    level_.member_start = std::exchange(member_start_, std::move(member_start));
  }

  void place_centres() {
    coarse_.place.resize(cluster_count_);
    team_.share(0, cluster_count_, [&](std::size_t begin, std::size_t end) {
      for (std::size_t c = begin; c < end; ++c) {
        Point sum{};
        double count = 0;
        for_members(c, [&](std::size_t node) {
          for (std::size_t i = 0; i < 3; ++i) {
            sum[i] += fine_.place[node][i];
          }
          ++count;
        });
        coarse_.place[c] = centre<Real>({sum[0] / count, sum[1] / count, sum[2] / count});
      }
    });
  }

  /// Clusters that other ranks' nodes have joined, as far as this one has copies of these.
  void follow_copies() {
    coarse_.ranks = fine_.ranks;
    if (!fine_.is_part()) {
      return;
    }

    struct Joined {
      std::int32_t cluster = 0;
      Point centre = {};
    };

    std::vector<Joined> joined(fine_.order.size());
    for (std::size_t node = 0; node < fine_.own_count(); ++node) {
      joined[node] = {.cluster = cluster_[node], .centre = coarse_.place[at(cluster_[node])]};
    }
    level_.halo->update(joined.data(), sizeof(Joined));
    std::map<host::Original, std::int32_t> known;
    for (const host::Copy& copy : fine_.copies) {
      const Joined& there = joined[at(copy.place)];
      const host::Original original = {.rank = copy.original.rank, .index = there.cluster};
      const auto [found, is_new] =
          known.try_emplace(original, static_cast<std::int32_t>(coarse_.place.size()));
      if (is_new) {
        coarse_.copies.push_back({.original = original, .place = found->second});
        coarse_.order.push_back(found->second);
        coarse_.place.push_back(there.centre);
        coarse_.key.push_back(0);  // Nobody asks.
      }
      cluster_[at(copy.place)] = found->second;
    }
    if (!coarse_.box.empty()) {
      coarse_.box.resize(coarse_.place.size());
    }
  }

  /// What was alone stays alone.
  void leave_alone() {
    coarse_.is_alone.assign(fine_.is_alone.empty() ? 0 : coarse_.order.size(), false);
    for (std::size_t node = 0; node < fine_.is_alone.size(); ++node) {
      if (fine_.is_alone[node]) {
        coarse_.is_alone[at(cluster_[node])] = true;
      }
    }
  }

  void seat_members() {
    level_.seat.reserve(fine_.order.size());
    for (std::size_t node = 0; node < fine_.order.size(); ++node) {
      const Point offset = difference(fine_.place[node], coarse_.place[at(cluster_[node])]);
      level_.seat.push_back({.offset = {static_cast<Real>(offset[0]), static_cast<Real>(offset[1]),
                                        static_cast<Real>(offset[2])},
                             .cluster = cluster_[node]});
    }
    level_.seat.finish();
  }

  /// Calls f(node, edge, other node) for every spring that leads out of a cluster.
  template <class F>
  void for_parts(std::size_t c, const F& f) const {
    for_members(c, [&](std::size_t node) {
      for (std::size_t e = at(fine_.start[node]); e < at(fine_.start[node + 1]); ++e) {
        const std::size_t other = at(fine_.other[e]);
        if (at(cluster_[other]) != c) {
          f(node, e, other);
        }
      }
    });
  }

  std::uint32_t spring_of(std::size_t node, std::size_t edge) const {
    return fine_.pattern[node] + static_cast<std::uint32_t>(edge - at(fine_.start[node]));
  }

  Point partner(std::size_t c, std::int32_t other) const {
    return rounded<Real>(difference(coarse_.place[at(other)], coarse_.place[c]));
  }

  /// The place of a cluster among a cluster's neighbours, in the order in which they are met.
  static std::uint32_t target_of(std::int32_t cluster, std::vector<std::int32_t>& targets) {
    const auto found = std::ranges::find(targets, cluster);
    const auto target = static_cast<std::uint32_t>(found - targets.begin());
    if (found == targets.end()) {
      targets.push_back(cluster);
    }
    return target;
  }

  /// The parts of a cluster's springs and its neighbours.
  void list_parts(std::size_t c, std::vector<Part>& parts,
                  std::vector<std::int32_t>& targets) const {
    parts.clear();
    targets.clear();
    for_parts(c, [&](std::size_t node, std::size_t edge, std::size_t other) {
      parts.push_back({.spring = spring_of(node, edge),
                       .target = target_of(cluster_[other], targets),
                       .is_weak = is_weak(edge),
                       .offset = offset(level_.seat[node]),
                       .far_offset = offset(level_.seat[other]),
                       .partner = partner(c, cluster_[other])});
    });
  }

  /// What a cluster's parts are made of, and its neighbours. (The far offsets follow from the
  /// rest.)
  Signature sign(std::size_t c, std::vector<std::int32_t>& targets) const {
    Signature signature;
    targets.clear();
    std::size_t last = fine_.order.size();
    for_parts(c, [&](std::size_t node, std::size_t edge, std::size_t other) {
      const std::size_t met_count = targets.size();
      const std::uint32_t target = target_of(cluster_[other], targets);
      signature.add(std::uint64_t{spring_of(node, edge)} << 32U | target << 1U |
                    (is_weak(edge) ? 1U : 0U));
      if (node != last) {
        const Point place = offset(level_.seat[node]);
        signature.add<Real>(place[0], place[1]);
        signature.add<Real>(place[2], 0);
        last = node;
      }
      if (target == met_count) {  // Met for the first time.
        const Point to = partner(c, cluster_[other]);
        signature.add<Real>(to[0], to[1]);
        signature.add<Real>(to[2], 0);
      }
    });
    return signature;
  }

  /// How much a part counts where means are taken: as cubes' parts are much alike, they count the
  /// same.
  double weight(const Part& part) const {
    if (fine_.is_along_axes) {
      return 1;
    }
    return fine_.springs[part.spring].strength();
  }

  /// Where a cluster's springs lead; `springs` have their partners.
  void find_directions(const std::vector<Part>& parts, std::span<Spring> springs) const {
    std::vector<double> weights(springs.size());
    for (const Part& part : parts) {
      const double share = weight(part);
      weights[part.target] += share;
      for (std::size_t k = 0; k < 3; ++k) {
        const double component = fine_.springs[part.spring].direction[k];
        springs[part.target].direction[k] +=
            share * (fine_.is_along_axes ? std::abs(component) : component);
      }
    }
    for (std::size_t i = 0; i < springs.size(); ++i) {
      Spring& spring = springs[i];
      spring.direction = fine_.is_along_axes
                             ? main_axis(spring.direction, spring.partner)
                             : mean_direction(spring.direction, weights[i], spring.partner);
    }
  }

  /// A pure function of the parts, so it does not matter which of many equal clusters is taken.
  void add_up(const std::vector<Part>& parts, std::span<Spring> springs) const {
    struct Sum {
      double length = 0;
      double reach = 0;
      double weight = 0;
    };

    for (const Part& part : parts) {
      springs[part.target].partner = part.partner;
    }
    find_directions(parts, springs);
    std::vector<Sum> sums(springs.size());
    for (const Part& part : parts) {
      const PackedSpring& fine = fine_.springs[part.spring];
      Spring& spring = springs[part.target];
      const double share = weight(part);
      base::add_to(spring.stiffness, carried(fine.stiffness(), part.offset));
      for (std::size_t k = 0; k < 3; ++k) {
        spring.middle[k] += share * (part.offset[k] + fine.middle[k]);
      }
      // Of springs that lead this way and that only the way across counts.
      const Point& way = fine_.is_along_axes ? fine.direction : spring.direction;
      const double length = fine.length * std::abs(dot(fine.direction, way));
      Sum& sum = sums[part.target];
      sum.length += share * length;
      // Behind a neck the robot is stiffer than the neck, which is as soft as it is long.
      sum.reach +=
          share *
          (length +
           (part.is_weak ? 0 : behind(part.offset, way) + behind(part.far_offset, opposite(way))));
      sum.weight += share;
    }
    for (std::size_t i = 0; i < springs.size(); ++i) {
      Spring& spring = springs[i];
      for (double& x : spring.middle) {
        x /= sums[i].weight;
      }
      spring.length = sums[i].reach / sums[i].weight;
      spring.stiffness = stretched(spring.stiffness, spring.middle, spring.direction,
                                   sums[i].length / sums[i].weight, spring.length);
    }
  }

  void make_springs() {
    std::vector<Signature> signatures(cluster_count_);
    coarse_.start.assign(coarse_.order.size() + 1, 0);
    std::vector<std::vector<std::int32_t>> others((cluster_count_ + Team::kChunk - 1) /
                                                  Team::kChunk);
    team_.share(0, cluster_count_, [&](std::size_t begin, std::size_t end) {
      std::vector<std::int32_t> targets;
      for (std::size_t c = begin; c < end; ++c) {
        signatures[c] = sign(c, targets);
        coarse_.start[c + 1] = static_cast<std::int32_t>(targets.size());
        std::vector<std::int32_t>& part = others[c / Team::kChunk];
        part.insert(part.end(), targets.begin(), targets.end());
      }
    });
    for (std::size_t c = 0; c + 1 < coarse_.start.size(); ++c) {
      coarse_.start[c + 1] += coarse_.start[c];
    }
    coarse_.other.reserve(at(coarse_.start[cluster_count_]));
    for (const std::vector<std::int32_t>& part : others) {
      coarse_.other.insert(coarse_.other.end(), part.begin(), part.end());
    }
    find_patterns(signatures);
  }

  void find_patterns(const std::vector<Signature>& signatures) {
    coarse_.pattern.resize(coarse_.order.size());
    std::unordered_map<Signature, std::uint32_t, SignatureHash> known;
    std::vector<std::int32_t> examples;
    std::uint32_t spring_count = 0;
    for (std::size_t c = 0; c < cluster_count_; ++c) {
      const auto [found, is_new] = known.try_emplace(signatures[c], spring_count);
      coarse_.pattern[c] = found->second;
      if (is_new) {
        examples.push_back(static_cast<std::int32_t>(c));
        spring_count += static_cast<std::uint32_t>(coarse_.start[c + 1] - coarse_.start[c]);
      }
    }
    coarse_.springs.resize(spring_count);
    team_.share(0, examples.size(), [&](std::size_t begin, std::size_t end) {
      std::vector<Part> parts;
      std::vector<std::int32_t> targets;
      std::vector<Spring> springs;
      for (std::size_t i = begin; i < end; ++i) {
        list_parts(at(examples[i]), parts, targets);
        springs.assign(targets.size(), {});
        add_up(parts, springs);
        std::ranges::transform(
            springs,
            coarse_.springs.begin() + static_cast<std::ptrdiff_t>(coarse_.pattern[at(examples[i])]),
            [](const Spring& spring) { return PackedSpring(spring); });
      }
    });
  }

  SpringGraph& fine_;
  Level<Real>& level_;
  Team& team_;
  SpringGraph& coarse_;
  std::vector<std::uint8_t> is_weak_;  ///< By edge of the fine level; empty if none is.
  std::size_t cluster_count_ = 0;
  std::vector<std::int32_t> cluster_;
  std::vector<std::int32_t> member_;
  std::vector<std::int32_t> member_start_;
  std::vector<std::int32_t> final_;
};

}  // namespace

template <class Real>
bool coarsen(SpringGraph& fine, Level<Real>& level, Team& team, SpringGraph& coarse,
             std::vector<std::size_t>& colour_start) {
  return Coarsening<Real>(fine, level, team, coarse).run(colour_start);
}

template bool coarsen(SpringGraph&, Level<float>&, Team&, SpringGraph&, std::vector<std::size_t>&);
template bool coarsen(SpringGraph&, Level<double>&, Team&, SpringGraph&, std::vector<std::size_t>&);

}  // namespace holdfast::solver
