// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// A front's algebra beside a dense Schur complement; the root's contact problem by its own
// equations.
#include "holdfast/agent/equilibrium/front.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "holdfast/agent/methods/front_contact.hpp"
#include "holdfast/base/rng.hpp"
#include "test_setup.hpp"
#include "world/facets.hpp"

namespace holdfast::agent {
namespace {

using base::Direction;
using test::lopsided_beam;

/// Memory for one front and its contact problem.
struct Store {
  std::vector<float> reals = std::vector<float>(10'000);
  std::vector<double> contact = std::vector<double>(contact_reals(24));
  FrontMemory memory{
      .nodes = {}, .reals = reals, .kept = {}, .contact = contact, .touching = {}, .queues = {}};
};

/// Four nodes in a ring, one more above the first, one fixed; nodes 1 and 3 are not complete.
std::vector<FrontNode> ring() {
  std::vector<FrontNode> nodes(6);
  nodes[0].cell = {0, 0, 0};
  nodes[1].cell = {1, 0, 0};
  nodes[1].is_kept = true;
  nodes[2].cell = {1, 1, 0};
  nodes[3].cell = {0, 1, 0};
  nodes[3].missing.add(Direction::kMinusX);
  nodes[4].cell = {0, 0, 1};
  nodes[5].cell = {2, 1, 0};
  nodes[5].is_fixed = true;
  return nodes;
}

struct Dense {
  Eigen::MatrixXd matrix;
  Eigen::VectorXd loads;
};

/// Puts all beams of neighbours into the front, and into a dense matrix with the same rows.
Dense filled(Front& front) {
  const auto beam = lopsided_beam();
  base::Rng rng(5);
  Dense dense{Eigen::MatrixXd::Zero(front.rows(), front.rows()), Eigen::VectorXd(front.rows())};
  const auto add = [&](int row, int column, const base::Mat6<double>& block) {
    for (int i = 0; i < 6; ++i) {
      for (int j = 0; j < 6; ++j) {
        dense.matrix(row + i, column + j) += block.at(i, j);
      }
    }
  };
  for (std::size_t p = 0; p < front.nodes().size(); ++p) {
    for (std::size_t q = 0; q < front.nodes().size(); ++q) {
      for (const Direction direction : base::kDirections) {
        const int row = front.row_of(p);
        const int column = front.row_of(q);
        if (base::neighbour(front.nodes()[p].cell, direction) != front.nodes()[q].cell || row < 0) {
          continue;
        }
        add(row, row, mechanics::block_11(beam, direction));
        front.add_block(row, row, mechanics::block_11(beam, direction));
        if (column >= 0) {
          add(row, column, mechanics::block_12(beam, direction));
        }
        if (column >= 0 && base::index(direction) % 2 == 0) {
          front.add_block(row, column, mechanics::block_12(beam, direction));
        }
      }
    }
  }
  for (int row = 0; row < front.rows(); ++row) {
    dense.loads(row) = static_cast<double>(rng.below(1000)) / 1000 - 0.5;
    front.load(row) = static_cast<float>(dense.loads(row));
  }
  return dense;
}

void factor(Front& front) {
  for (int row = 0; row < front.rows(); ++row) {
    ASSERT_TRUE(front.factor_row(row));
  }
  front.condense_loads();
}

/// Complete nodes come first; a fixed one has no rows. Single precision: 2^-24, times a condition
/// of a few thousands.
TEST(Front, condenses_to_the_schur_complement) {
  Store store;
  auto nodes = ring();
  Front front;
  ASSERT_TRUE(front.make(nodes, store.memory));
  EXPECT_EQ(front.complete_count(), 4U);
  EXPECT_EQ(front.rows(), 30);
  EXPECT_EQ(front.complete_rows(), 18);
  const Dense dense = filled(front);
  factor(front);
  const Eigen::MatrixXd inner = dense.matrix.topLeftCorner(18, 18).inverse();
  const Eigen::MatrixXd lower = dense.matrix.bottomLeftCorner(12, 18);
  const Eigen::MatrixXd schur =
      dense.matrix.bottomRightCorner(12, 12) - lower * inner * lower.transpose();
  const Eigen::VectorXd loads = dense.loads.tail(12) - lower * inner * dense.loads.head(18);
  const double size = dense.matrix.diagonal().maxCoeff();
  int index = 0;
  for (int i = 0; i < 12; ++i) {
    EXPECT_NEAR(front.load(18 + i), loads(i), 1e-3 * loads.cwiseAbs().maxCoeff());
    for (int j = 0; j <= i; ++j) {
      EXPECT_NEAR(front.element_left(index++), schur(i, j), 1e-5 * size);
    }
  }
  EXPECT_EQ(front.element_left(index), 0);
}

/// Twelve digits in two parts are 2^-48, times as much; the second parts alone tell it from single
/// precision.
TEST(Front, condenses_to_twelve_digits_where_matrices_have_two_parts) {
  Store store;
  store.memory.has_low_parts = true;
  auto nodes = ring();
  Front front;
  ASSERT_TRUE(front.make(nodes, store.memory));
  const Dense dense = filled(front);
  factor(front);
  const Eigen::MatrixXd lower = dense.matrix.bottomLeftCorner(12, 18);
  const Eigen::MatrixXd schur =
      dense.matrix.bottomRightCorner(12, 12) -
      lower * dense.matrix.topLeftCorner(18, 18).ldlt().solve(lower.transpose());
  const double size = dense.matrix.diagonal().maxCoeff();
  int index = 0;
  double low_most = 0;
  for (int i = 0; i < 12; ++i) {
    for (int j = 0; j <= i; ++j) {
      EXPECT_NEAR(front.element(18 + i, 18 + j), schur(i, j), 1e-12 * size);
      low_most = std::max(low_most, std::abs(double{front.element_left(index++, true)}));
    }
  }
  EXPECT_GT(low_most, 1e-10 * size);
}

TEST(Front, finds_the_shifts_of_what_was_eliminated) {
  Store store;
  auto nodes = ring();
  Front front;
  ASSERT_TRUE(front.make(nodes, store.memory));
  const Dense dense = filled(front);
  factor(front);
  Eigen::VectorXd above(12);
  for (int i = 0; i < 12; ++i) {
    above(i) = 1e-3 * (i + 1);
    front.shift(18 + i) = static_cast<float>(above(i));
  }
  front.find_shifts();
  const Eigen::VectorXd expected = dense.matrix.topLeftCorner(18, 18).ldlt().solve(
      dense.loads.head(18) - dense.matrix.topRightCorner(18, 12) * above);
  for (int i = 0; i < 18; ++i) {
    EXPECT_NEAR(front.shift(i), expected(i), 1e-3 * expected.cwiseAbs().maxCoeff());
  }
}

TEST(Front, says_so_if_there_is_no_room_or_nothing_holds_it) {
  Store store;
  store.memory.reals = store.memory.reals.first(500);
  auto nodes = ring();
  Front front;
  EXPECT_FALSE(front.make(nodes, store.memory));
  store.memory = {
      .nodes = {}, .reals = store.reals, .kept = {}, .contact = {}, .touching = {}, .queues = {}};
  ASSERT_TRUE(front.make(nodes, store.memory));
  EXPECT_FALSE(front.factor_row(0));
}

/// A post of two modules on one foot, pushed sideways at its top so that the foot rolls onto an
/// edge: the lower one is kept, the upper one eliminated.
class Post {
 public:
  Post(mechanics::ContactLaw law, double push_n, const base::Vec6<double>& place = {})
      : facet_(mechanics::ground_facet(lopsided_beam(), 40.0, 40.0, 1e-4, law)) {
    nodes_[0].cell = {0, 0, 0};
    nodes_[0].is_kept = true;
    nodes_[1].cell = {0, 0, 1};
    EXPECT_TRUE(front_.make(nodes_, store_.memory));
    filled(front_);
    front_.clear_loads();
    front_.load(0) = static_cast<float>(push_n);
    front_.load(2) = -static_cast<float>(test::kWeight);
    front_.load(8) = -static_cast<float>(test::kWeight);
    factor(front_);
    for (std::size_t i = 0; i < 6; ++i) {
      loads_[i] = static_cast<double>(front_.load(6 + static_cast<int>(i)));
    }
    solve_from(place);
  }

  /// Solves from a place beside u: the loads are what is left over there.
  void solve_from(const base::Vec6<double>& beside) {
    base::add_to(kept_.u, beside);
    const auto left = left_over(
        mechanics::contact_state(facet_, mechanics::trial_force(facet_, kept_.u)), kept_.u);
    for (std::size_t i = 0; i < 6; ++i) {
      front_.load(6 + static_cast<int>(i)) = static_cast<float>(left[i]);
    }
    kept_.force = mechanics::contact_force(
        facet_, mechanics::contact_state(facet_, mechanics::trial_force(facet_, kept_.u)), true,
        kept_.u);
    const ContactSetting setting{.facet = facet_};
    FrontContact contact(setting, front_, std::span(&kept_, 1), store_.contact);
    is_solved_ = contact.solve();
  }

  bool is_solved() const { return is_solved_; }

  const KeptNode& foot() const { return kept_; }

  /// Does the state belong to the displacement, and is S d + F = h?
  void expect_equilibrium() const {
    EXPECT_EQ(kept_.state,
              mechanics::contact_state(facet_, mechanics::trial_force(facet_, kept_.u)));
    for (const double value : left_over(kept_.state, kept_.u)) {
      EXPECT_NEAR(value, 0, 1e-3);
    }
  }

 private:
  base::Vec6<double> left_over(const mechanics::ContactState& state,
                               const base::Vec6<double>& u) const {
    const auto force = mechanics::contact_force(facet_, state, true, u);
    base::Vec6<double> left{};
    for (int i = 0; i < 6; ++i) {
      const auto at = static_cast<std::size_t>(i);
      left[at] = loads_[at] - force[at];
      for (int j = 0; j < 6; ++j) {
        left[at] -= front_.element(6 + (i > j ? i : j), 6 + (i > j ? j : i)) *
                    u[static_cast<std::size_t>(j)];
      }
    }
    return left;
  }

  Store store_;
  std::vector<FrontNode> nodes_ = std::vector<FrontNode>(2);
  Front front_;
  mechanics::GroundFacet<double> facet_;
  base::Vec6<double> loads_{};
  KeptNode kept_{.u = {}, .state = {.pressed = true}};
  bool is_solved_ = false;
};

/// Half the width is 20 mm, the push acts 60 mm up: the foot rolls from 2 W 20 / 60 on, and
/// carries 2 W.
TEST(FrontContact, a_foot_rolls_when_the_push_is_too_large) {
  constexpr double kLimit = 2 * test::kWeight * 20 / 60;
  for (const auto law : {mechanics::ContactLaw::kRegularised, mechanics::ContactLaw::kUnilateral}) {
    const Post stands(law, 0.9 * kLimit);
    ASSERT_TRUE(stands.is_solved());
    EXPECT_EQ(stands.foot().state, mechanics::ContactState{.pressed = true});
    stands.expect_equilibrium();
  }
  const Post rolls(mechanics::ContactLaw::kRegularised, 1.1 * kLimit);
  ASSERT_TRUE(rolls.is_solved());
  EXPECT_NE(rolls.foot().state.tilt_y, 0);
  rolls.expect_equilibrium();
}

/// Nothing is left over at the solution; from a place beside it the loads are what the facet does
/// not yet carry, and the same solution is found.
TEST(FrontContact, loads_are_what_is_left_over) {
  for (const auto law : {mechanics::ContactLaw::kRegularised, mechanics::ContactLaw::kUnilateral}) {
    Post post(law, 10);
    const auto u = post.foot().u;
    post.solve_from({});
    for (std::size_t i = 0; i < 6; ++i) {
      EXPECT_NEAR(post.foot().u[i], u[i], 1e-5 * (1e-3 + std::abs(u[i])));
    }
    post.solve_from({1e-3, 0, -1e-2, 0, 1e-4, 0});
    for (std::size_t i = 0; i < 6; ++i) {
      EXPECT_NEAR(post.foot().u[i], u[i], 1e-5 * (1e-3 + std::abs(u[i])));
    }
  }
}

/// The foot does not press yet and nothing else holds the post: what rounding has left of the
/// stiffness against moving as a whole is of either sign.
TEST(FrontContact, a_robot_that_nothing_holds_yet_comes_down_under_the_unilateral_law) {
  Post stands(mechanics::ContactLaw::kUnilateral, 1, {0, 0, 1e-3, 0, 0, 0});
  ASSERT_TRUE(stands.is_solved());
  stands.solve_from({});  // Once more, as shifts are in single precision.
  EXPECT_TRUE(stands.foot().state.pressed);
  stands.expect_equilibrium();
}

/// The post again, its lower module on the floor and before a wall, pushed and turned anyhow. What
/// it comes to is an equilibrium whose states are those that the law prescribes, by both laws.
TEST(FrontContact, a_node_may_touch_several_things) {
  const auto beam = lopsided_beam();
  int wall_count = 0;
  int tilting_count = 0;
  for (const auto law : {mechanics::ContactLaw::kRegularised, mechanics::ContactLaw::kUnilateral}) {
    const ContactSetting setting{.facet = mechanics::ground_facet(beam, 40.0, 40.0, 1e-4, law)};
    for (std::uint64_t seed = 0; seed < 40; ++seed) {
      SCOPED_TRACE(seed);
      Store store;
      std::vector<FrontNode> nodes(2);
      nodes[0].is_kept = true;
      nodes[1].cell = {0, 0, 1};
      Front front;
      ASSERT_TRUE(front.make(nodes, store.memory));
      filled(front);
      front.clear_loads();
      base::Rng rng(seed);
      for (int row = 0; row < 6; ++row) {
        const double share = static_cast<double>(rng.below(1000)) / 1000 - 0.5;
        front.load(row) = static_cast<float>(test::kWeight * (row < 3 ? share : 200 * share));
      }
      front.load(2) = front.load(8) = -static_cast<float>(test::kWeight);
      factor(front);
      const Environment environment;
      Surroundings surroundings{.environment = &environment, .facet_count = 2};
      surroundings.facets[0] = {.direction = Direction::kMinusZ, .state = {.pressed = true}};
      surroundings.facets[1] = {.direction = Direction::kPlusX, .state = {.pressed = true}};
      KeptNode kept{};
      kept.surroundings = &surroundings;
      FrontContact contact(setting, front, std::span(&kept, 1), store.contact);
      if (!contact.solve()) {
        EXPECT_EQ(law, mechanics::ContactLaw::kRegularised);
        continue;
      }
      const std::array found = {surroundings.facets[0].state, surroundings.facets[1].state};
      EXPECT_FALSE(follow_states_at(kept, setting, kept.u));
      const base::Vec6<double> force = facet_force(kept, setting, kept.u);
      for (int i = 0; i < 6; ++i) {
        double left = static_cast<double>(front.load(6 + i)) - force[static_cast<std::size_t>(i)];
        for (int j = 0; j < 6; ++j) {
          left -= front.element(6 + std::max(i, j), 6 + std::min(i, j)) *
                  kept.u[static_cast<std::size_t>(j)];
        }
        EXPECT_NEAR(left, 0, 1e-2);  // Of 60 N mm; shifts are in single precision.
      }
      wall_count += found[1].pressed ? 1 : 0;
      tilting_count += found[0].tilt_x != 0 || found[0].tilt_y != 0 ? 1 : 0;
    }
  }
  EXPECT_GT(wall_count, 10);
  EXPECT_GT(tilting_count, 10);
}

}  // namespace
}  // namespace holdfast::agent
