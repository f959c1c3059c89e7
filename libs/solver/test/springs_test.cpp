// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
// The springs of the multigrid's levels beside their definitions: dense products with T(a), the
// paper's K12, beam theory for a beam of another length.
#include "../src/multigrid/coarsening/springs.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <cstring>
#include <map>

#include "../src/multigrid/coarsening/weak_springs.hpp"
#include "../src/multigrid/kernels/beam_shapes.hpp"
#include "random_numbers.hpp"

namespace holdfast::solver {
namespace {

using Dense = Eigen::Matrix<double, 6, 6>;

Dense dense(const Mat& m) { return Eigen::Map<const Dense>(m.values.data()); }

/// T(a) [u, t] = [u + t x a, t].
Dense carrying(const Point& a) {
  Dense t = Dense::Identity();
  t(0, 4) = a[2];
  t(0, 5) = -a[1];
  t(1, 5) = a[0];
  t(1, 3) = -a[2];
  t(2, 3) = a[1];
  t(2, 4) = -a[0];
  return t;
}

/// A symmetric positive matrix with no other structure.
Mat random_spring(base::Rng& rng) {
  Dense a;
  for (int i = 0; i < 36; ++i) {
    a(i) = random_number(rng);
  }
  Mat result;
  Eigen::Map<Dense>(result.values.data()) = a * a.transpose() + 0.1 * Dense::Identity();
  return result;
}

Point random_point(base::Rng& rng) {
  return {random_number(rng), 2 + 3 * random_number(rng), -2 * random_number(rng)};
}

/// Largest difference as a share of the largest entry.
double difference(const Dense& a, const Dense& b) {
  return (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff();
}

/// A dozen roundings of an entry.
constexpr double kRounding = 3e-15;

TEST(Springs, a_spring_seen_from_elsewhere_is_the_product_of_its_definition) {
  base::Rng rng(1);
  for (int turn = 0; turn < 100; ++turn) {
    const Mat s = random_spring(rng);
    const Point a = random_point(rng);
    EXPECT_LT(difference(dense(times_carry(s, a)), dense(s) * carrying(a)), kRounding);
    EXPECT_LT(difference(dense(carried(s, a)), carrying(a).transpose() * dense(s) * carrying(a)),
              kRounding);
  }
}

TEST(Springs, carried_there_and_back_a_spring_is_as_before) {
  base::Rng rng(2);
  for (int turn = 0; turn < 100; ++turn) {
    const Mat s = random_spring(rng);
    const Point a = random_point(rng);
    const Mat back = carried(carried(s, a), {-a[0], -a[1], -a[2]});
    // Entries grow by |a|^2 < 20 on the way, so that much more is rounded away.
    EXPECT_LT(difference(dense(back), dense(s)), 100 * kRounding);
  }
}

/// K_pq = -S T(x_p - x_q) is the paper's K12.
TEST(Springs, a_beams_spring_couples_its_ends_as_k12_does) {
  const model::Material material;
  for (std::size_t direction = 0; direction < 6; ++direction) {
    for (const std::size_t length : {1U, 2U, 7U}) {
      const Spring spring = beam_spring(base::kCubic, material, direction, length);
      const Mat coupled = times_carry(spring.stiffness, solver::difference({}, spring.partner));
      const Mat k12 = long_beam(material, base::kCubic, static_cast<int>(length))
                          .block_12(static_cast<base::Direction>(direction));
      EXPECT_LT(difference(-dense(coupled), dense(k12)), kRounding);
    }
  }
}

/// The compliance of a beam of length L at its middle is L/EA along it, L/GJ about it, L/EI about
/// the axes across, and L^3/12EI across: all four are independent there. Lengthened from L to R its
/// compliance is that of a beam of length R, but that of the bending that shifts the middle,
/// (R^2 - L^2)/12 of the rotation, only kBendShare is taken, and all is divided by kCorrection.
TEST(Springs, a_stretched_beam_gives_as_beam_theory_says) {
  const model::Material material;
  for (std::size_t direction = 0; direction < 6; ++direction) {
    const std::size_t axis = direction / 2;
    for (const auto& [length, reach] : {std::pair{1, 2}, {2, 3}, {3, 11}, {4, 4}}) {
      const Spring from =
          beam_spring(base::kCubic, material, direction, static_cast<std::size_t>(length));
      const Spring to =
          beam_spring(base::kCubic, material, direction, static_cast<std::size_t>(reach));
      const Mat longer =
          stretched(from.stiffness, from.middle, from.direction, from.length, to.length);
      const auto at_middle = [&](const Mat& s) {
        return carried(s, {-from.middle[0], -from.middle[1], -from.middle[2]});
      };
      const auto middle_of = [](const Spring& spring) {
        return dense(
            carried(spring.stiffness, {-spring.middle[0], -spring.middle[1], -spring.middle[2]}));
      };
      const Dense found = dense(at_middle(longer)).inverse();
      const Dense shorter = middle_of(from).inverse();
      Dense expected = middle_of(to).inverse();
      for (std::size_t across = 0; across < 3; ++across) {
        if (across != axis) {
          const auto i = static_cast<Eigen::Index>(across);
          const double ratio = to.length / from.length;
          // The shear part alone lengthens in proportion; the rest is bending.
          const double without_bending = shorter(i, i) * ratio;
          expected(i, i) = without_bending + kBendShare * (expected(i, i) - without_bending);
        }
      }
      expected /= kCorrection;
      EXPECT_LT((found - expected).cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff(), 1e-12);
      for (Eigen::Index i = 0; i < 6; ++i) {
        EXPECT_NEAR(found(i, i) / expected(i, i), 1, 1e-9) << direction << " " << i;
      }
    }
  }
}

/// A beam's direction makes no difference: what does not depend on the frame, the traces of the
/// compliance's quarters and what it gives along and about the beam, is that of a cube's beam of
/// equal stiffness both ways.
TEST(Springs, a_beam_stretches_alike_in_every_direction_of_every_lattice) {
  const model::Material material;
  const auto compliance = [&](const base::Lattice& lattice, std::size_t direction) {
    const Spring from = beam_spring(lattice, material, direction, 1);
    const Spring to = beam_spring(lattice, material, direction, 3);
    const Mat longer =
        stretched(from.stiffness, from.middle, from.direction, from.length, to.length);
    const Dense at_middle =
        dense(carried(longer, {-from.middle[0], -from.middle[1], -from.middle[2]})).inverse();
    const Eigen::Map<const Eigen::Vector3d> n(from.direction.data());
    const Eigen::Matrix3d shifts = at_middle.topLeftCorner<3, 3>();
    const Eigen::Matrix3d turns = at_middle.bottomRightCorner<3, 3>();
    return Eigen::Vector4d(shifts.trace(), n.dot(shifts * n), turns.trace(), n.dot(turns * n));
  };
  const Eigen::Vector4d expected = compliance(base::kCubic, 0);
  for (const base::Lattice& lattice :
       {base::kFaceCentred, base::kHexagonal, base::kHexagonalPrism}) {
    for (const base::Direction direction : base::directions(lattice)) {
      const Eigen::Vector4d found = compliance(lattice, base::at(base::index(direction)));
      EXPECT_LT((found.array() / expected.array() - 1).abs().maxCoeff(), 1e-9);
    }
  }
}

/// Two bodies at each end of a chain 0 = 1 - 2 = 3, with springs s E between 1 and 2 and E in the
/// others: the share of the middle one in what holds its bodies is s / (1 + s) at both.
SpringGraph chain(double s) {
  Mat unit{};
  for (std::size_t i = 0; i < 6; ++i) {
    unit.values[7 * i] = 1;
  }
  SpringGraph graph;
  graph.order = {0, 1, 2, 3};
  graph.start = {0, 1, 3, 5, 6};
  graph.other = {1, 0, 2, 1, 3, 2};
  graph.pattern = {0, 1, 3, 5};
  for (const double stiffness : {1.0, 1.0, s, s, 1.0, 1.0}) {
    graph.springs.emplace_back(Spring{.stiffness = scaled(unit, stiffness)});
  }
  graph.shift = 3;
  return graph;
}

std::vector<std::uint8_t> weak_in_whole(const SpringGraph& graph) {
  host::Team team(1);
  host::NoCopies none;
  return weak_springs(graph, team, none);
}

/// Weak is what resists some motion by less than 0.007 of what all springs of the node do.
TEST(WeakSprings, a_spring_is_weak_below_a_share_of_what_holds_its_nodes) {
  const auto with_share = [](double share) { return chain(share / (1 - share)); };
  EXPECT_TRUE(weak_in_whole(with_share(0.00701)).empty());
  const std::vector<std::uint8_t> weak = weak_in_whole(with_share(0.00699));
  EXPECT_EQ(weak, (std::vector<std::uint8_t>{0, 0, 1, 1, 0, 0}));
}

/// A body on one spring alone is held by nothing else, so that spring is not weak there,
/// however weak it is at the other end.
TEST(WeakSprings, what_hangs_on_one_spring_alone_joins_it) {
  SpringGraph graph = chain(1);
  const PackedSpring soft(Spring{.stiffness = scaled(graph.springs[1].stiffness(), 1e-5)});
  graph.springs[0] = graph.springs[1] = soft;
  EXPECT_TRUE(weak_in_whole(graph).empty() || weak_in_whole(graph) == std::vector<std::uint8_t>(6));
}

/// Between single modules each spring is one beam, and none counts as weak.
TEST(WeakSprings, on_the_finest_level_none_is_weak) {
  SpringGraph graph = chain(1e-6);
  graph.shift = 0;
  EXPECT_TRUE(weak_in_whole(graph).empty());
}

/// What each rank has last had for its nodes, as bytes.
using Mail = std::map<host::Original, std::vector<std::byte>>;

/// Posts this rank's items, and fetches what others have posted before.
class MailHalo final : public host::Halo {
 public:
  MailHalo(const SpringGraph& graph, Mail& mail) : graph_(graph), mail_(mail) {}

  void update(void* items, std::size_t size) override {
    auto* const bytes = static_cast<std::byte*>(items);
    for (std::size_t node = 0; node < graph_.own_count(); ++node) {
      const host::Original own = {.rank = graph_.ranks.get().rank(),
                                  .index = static_cast<std::int32_t>(node)};
      mail_[own].assign(bytes + node * size, bytes + (node + 1) * size);
    }
    for (const host::Copy& copy : graph_.copies) {
      const auto posted = mail_.find(copy.original);
      if (posted != mail_.end()) {
        std::memcpy(bytes + base::at(copy.place) * size, posted->second.data(), size);
      }
    }
  }

 private:
  const SpringGraph& graph_;
  Mail& mail_;
};

/// One of two ranks, the other of which says yes to everything.
class OneOfTwo final : public host::Ranks {
 public:
  explicit OneOfTwo(int rank) : rank_(rank) {}

  int rank() const override { return rank_; }

  int count() const override { return 2; }

  double sum(double mine) override { return mine; }

  double max(double) override { return 1; }

  void sum(std::span<double>) override {}

  std::vector<std::byte> gather(std::span<const std::byte>) override { return {}; }

  std::unique_ptr<host::Halo> make_halo(std::size_t, std::span<const host::Copy>) override {
    return nullptr;
  }

  void log(host::Work, bool) override {}

  bool is_own_method(const host::KrylovTask&) override { return true; }

  void watch(const host::KrylovTask&) override {}

  bool solve(const host::KrylovTask&, std::span<const double>, std::span<double>) override {
    return true;
  }

 private:
  int rank_;
};

/// The half of a chain that a rank has, and a copy of the other's end: 0 = 1 - [2] and
/// [1] - 2 = 3, whose 2 and 3 are then 0 and 1.
SpringGraph half_chain(const SpringGraph& whole, OneOfTwo& ranks) {
  const bool is_second = ranks.rank() == 1;
  SpringGraph half;
  half.ranks = ranks;
  half.order = {0, 1, 2};
  half.copies = {{.original = {.rank = is_second ? 0 : 1, .index = is_second ? 1 : 0}, .place = 2}};
  half.start =
      is_second ? std::vector<std::int32_t>{0, 2, 3, 3} : std::vector<std::int32_t>{0, 1, 3, 3};
  half.other = is_second ? std::vector<std::int32_t>{2, 1, 0} : std::vector<std::int32_t>{1, 0, 2};
  half.pattern = is_second ? std::vector<std::uint32_t>{0, 2} : std::vector<std::uint32_t>{0, 1};
  const auto first = whole.springs.begin() + (is_second ? 3 : 0);
  half.springs.assign(first, first + 3);
  half.shift = whole.shift;
  return half;
}

/// What two ranks find of the halves of a chain, in the order of the whole one's edges. The first
/// is asked again when the second has sent it what it finds.
std::vector<std::uint8_t> weak_in_halves(const SpringGraph& whole) {
  host::Team team(1);
  OneOfTwo first(0);
  OneOfTwo second(1);
  const SpringGraph left = half_chain(whole, first);
  const SpringGraph right = half_chain(whole, second);
  Mail mail;
  MailHalo left_halo(left, mail);
  MailHalo right_halo(right, mail);
  weak_springs(left, team, left_halo);
  const std::vector<std::uint8_t> of_right = weak_springs(right, team, right_halo);
  std::vector<std::uint8_t> all = weak_springs(left, team, left_halo);
  all.insert(all.end(), of_right.begin(), of_right.end());
  return all;
}

/// A neck between two ranks is one at both, and what is weak at one end only is none.
TEST(WeakSprings, ranks_find_those_of_the_whole) {
  const SpringGraph whole = chain(0.006);
  EXPECT_EQ(weak_in_whole(whole), (std::vector<std::uint8_t>{0, 0, 1, 1, 0, 0}));
  EXPECT_EQ(weak_in_halves(whole), weak_in_whole(whole));
  SpringGraph soft_end = whole;  // Holds the third body by so little that the middle spring counts.
  const Mat soft = scaled(whole.springs[4].stiffness(), 0.1);
  soft_end.springs[4] = soft_end.springs[5] = PackedSpring(Spring{.stiffness = soft});
  EXPECT_TRUE(weak_in_whole(soft_end).empty() ||
              weak_in_whole(soft_end) == std::vector<std::uint8_t>(6));
  EXPECT_EQ(weak_in_halves(soft_end), std::vector<std::uint8_t>(6));
}

}  // namespace
}  // namespace holdfast::solver
