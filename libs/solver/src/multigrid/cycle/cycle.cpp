// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "multigrid/cycle/cycle.hpp"

#include <algorithm>
#include <array>
#include <type_traits>

namespace holdfast::solver {
namespace {

/// One step of the inner iteration is enough if it removes this share of the residual; Notay's.
constexpr double kGoodShare = 0.25;

/// How often the coarsest level's solution is refined.
template <class Real>
constexpr int kCoarsestRefinementCount = std::is_same_v<Real, double> ? 2 : 0;

/// What the sweeps work on.
std::span<Six<float>> swept_r(Level<float>& level) { return level.r; }

std::span<Six<float>> swept_r(Level<double>& level) { return level.rough_r; }

std::span<Six<float>> swept_z(Level<float>& level) { return level.z; }

std::span<Six<float>> swept_z(Level<double>& level) { return level.rough_z; }

/// The cycle's own length is right within a factor of two or so. A step far from 1 is rounding: on
/// a slender robot the energy of a smooth motion drowns in single precision, and no step is better.
bool is_credible(double step) { return step > 0.25 && step < 4; }

}  // namespace

template <class Real>
void Cycle<Real>::relax_colour(std::size_t depth, std::size_t colour, bool is_first) {
  Level<Real>& level = hierarchy_.levels()[depth];
  const Six<float>* r = swept_r(level).data();
  Six<float>* z = swept_z(level).data();
  team_.share(level.colour_start[colour], level.colour_start[colour + 1],
              [&](std::size_t begin, std::size_t end) {
                const Range range{begin, end};
                if (is_first) {
                  sweeps().relax_first(level.type.data(), level.inverse.data(), r, z, range);
                } else {
                  sweeps().relax(level.block_view(), r, z, range);
                }
              });
}

/// All sweeps before or after the coarse correction.
template <class Real>
void Cycle<Real>::relax(std::size_t depth, Order order, Start start) {
  Level<Real>& level = hierarchy_.levels()[depth];
  const std::size_t colour_count = level.colour_start.size() - 1;
  const auto colour_at = [&](std::size_t i) {
    return order == Order::kForward ? i : colour_count - 1 - i;
  };
  if (start == Start::kZero) {
    // A colour sees only those before it, so the rest must be zero in the first sweep.
    const std::size_t first = colour_at(0);
    const std::span<Six<float>> z = swept_z(level);
    team_.share(0, level.node_count, [&](std::size_t begin, std::size_t end) {
      const std::size_t own_begin = std::clamp(level.colour_start[first], begin, end);
      const std::size_t own_end = std::clamp(level.colour_start[first + 1], begin, end);
      std::fill(z.data() + begin, z.data() + own_begin, Six<float>{});
      std::fill(z.data() + own_end, z.data() + end, Six<float>{});
    });
    std::fill(z.data() + level.node_count, z.data() + level.place_count, Six<float>{});
  }
  for (int sweep = 0; sweep < sweep_count_; ++sweep) {
    for (std::size_t i = 0; i < colour_count; ++i) {
      relax_colour(depth, colour_at(i), start == Start::kZero && sweep == 0 && i == 0);
      hierarchy_.update_copies(depth, colour_at(i), swept_z(level));
    }
  }
}

/// Where the forces on a coarse level's clusters go: those of this rank's, if it is gathered.
template <class Real>
typename Cycle<Real>::Vector Cycle<Real>::passed_down(std::size_t depth) {
  Level<Real>& coarse = hierarchy_.levels()[depth];
  return coarse.gathering.is_empty() ? coarse.r : Vector(coarse.part);
}

/// Gathers the forces on all ranks' clusters, if the level is gathered.
template <class Real>
void Cycle<Real>::gather_forces(std::size_t depth) {
  Level<Real>& coarse = hierarchy_.levels()[depth];
  if (!coarse.gathering.is_empty()) {
    const std::vector<Six<Real>> all =
        host::gather<Six<Real>>(hierarchy_.ranks(depth - 1), coarse.part);
    for (std::size_t i = 0; i < all.size(); ++i) {
      coarse.r[static_cast<std::size_t>(coarse.gathering.node[i])] = all[i];
    }
  }
}

/// How the clusters move that this rank's nodes belong to.
template <class Real>
typename Cycle<Real>::Vector Cycle<Real>::passed_up(std::size_t depth) {
  Level<Real>& coarse = hierarchy_.levels()[depth];
  const Gathering& gathering = coarse.gathering;
  if (gathering.is_empty()) {
    return coarse.z;
  }
  for (std::size_t i = 0; i < gathering.own_count; ++i) {
    coarse.part[i] = coarse.z[static_cast<std::size_t>(gathering.node[gathering.first + i])];
  }
  return coarse.part;
}

/// The forces that the sweeps left at the members become those of the clusters.
template <class Real>
void Cycle<Real>::pass_down(std::size_t depth, std::size_t settled) {
  Level<Real>& level = hierarchy_.levels()[depth];
  const std::size_t cluster_count = level.member_start.size() - 1;
  const Vector forces = passed_down(depth + 1);
  const Six<float>* z = swept_z(level).data();
  team_.share(0, cluster_count, [&](std::size_t begin, std::size_t end) {
    kernels<Real>().restrict_to(level.view(), level.transfer(), settled, level.r.data(), z,
                                forces.data(), {begin, end});
  });
  gather_forces(depth + 1);
}

template <>
double Cycle<float>::run(SplitView<float> r) {
  sweep(0);
  const Level<float>& level = hierarchy_.levels().front();
  return team_.sum(level.node_count, [&](std::size_t begin, std::size_t end) {
    return kernels<float>().dot_split(r, level.z.data(), {begin, end});
  });
}

template <>
double Cycle<double>::run(SplitView<double> /*r*/) {
  return descend(0);
}

/// z = M^-1 r on this level and all below; returns this rank's part of r . z.
template <>
double Cycle<float>::descend(std::size_t depth) {
  sweep(depth);
  const Level<float>& level = hierarchy_.levels()[depth];
  return own_dot(level.z, level.r, level.node_count);
}

template <>
double Cycle<double>::descend(std::size_t depth) {
  sweep(depth);
  return add_rough(depth);
}

/// All of descend() but its last pass.
template <>
void Cycle<float>::sweep(std::size_t depth) {
  Level<float>& level = hierarchy_.levels()[depth];
  relax(depth, Order::kForward, Start::kZero);
  if (depth + 1 < hierarchy_.levels().size()) {
    // The last colour has no forces left, and its correction would be overwritten by the next
    // sweep.
    const std::size_t settled = level.colour_start[level.colour_start.size() - 2];
    pass_down(depth, settled);
    solve(depth + 1);
    const Vector motion = passed_up(depth + 1);
    team_.share(0, settled, [&](std::size_t begin, std::size_t end) {
      kernels<float>().prolong(level.transfer(), motion.data(), level.z.data(), {begin, end});
    });
    hierarchy_.update_copies(depth, level.z);
  }
  relax(depth, Order::kBackward, Start::kPresent);
}

/// What z leaves of r, for the sweeps.
template <>
void Cycle<double>::leave_residual(std::size_t depth) {
  Level<double>& level = hierarchy_.levels()[depth];
  team_.share(0, level.node_count, [&](std::size_t begin, std::size_t end) {
    rounding().leave(level.view(), level.r.data(), level.z.data(), level.rough_r.data(),
                     {begin, end});
  });
}

/// The cycle in double precision with sweeps in single: they begin at zero each time, so what they
/// find is small and has no digits to lose. What is large, the clusters' motion, and what it leaves
/// of r is in double precision. There, as in single precision no forces are left only up to its
/// rounding, all nodes' forces are passed down.
template <>
void Cycle<double>::sweep(std::size_t depth) {
  Level<double>& level = hierarchy_.levels()[depth];
  team_.share(0, level.node_count, [&](std::size_t begin, std::size_t end) {
    rounding().round(level.r.data(), level.rough_r.data(), {begin, end});
  });
  relax(depth, Order::kForward, Start::kZero);
  if (depth + 1 < hierarchy_.levels().size()) {
    pass_down(depth, level.node_count);
    solve(depth + 1);
    const Vector motion = passed_up(depth + 1);
    team_.share(0, level.node_count, [&](std::size_t begin, std::size_t end) {
      rounding().prolong(level.transfer(), motion.data(), level.rough_z.data(), level.z.data(),
                         {begin, end});
    });
    hierarchy_.update_copies(depth, level.z);
  } else {
    std::fill(level.z.begin(), level.z.end(), Six<double>{});
    add_rough(depth);
  }
  leave_residual(depth);
  relax(depth, Order::kBackward, Start::kZero);
}

/// z += what the sweeps found; returns this rank's part of r . z.
template <>
double Cycle<double>::add_rough(std::size_t depth) {
  Level<double>& level = hierarchy_.levels()[depth];
  const double work = team_.sum(level.node_count, [&](std::size_t begin, std::size_t end) {
    return rounding().add(level.rough_z.data(), level.r.data(), level.z.data(), {begin, end});
  });
  hierarchy_.update_copies(depth, level.z);
  return work;
}

/// K z = r on a coarse level, about: Algorithm 3.2 of [Notay 2008].
template <class Real>
void Cycle<Real>::solve(std::size_t depth) {
  if (depth + 1 == hierarchy_.levels().size() && hierarchy_.has_coarsest()) {
    solve_coarsest();
    return;
  }
  Level<Real>& level = hierarchy_.levels()[depth];
  const std::size_t count = level.node_count;
  const double own_work = descend(depth);
  const auto [before, alpha_1, rho_1] = host::sum(
      hierarchy_.ranks(depth),
      std::array{own_dot(level.r, level.r, count), own_work, apply(depth, level.first_image)});
  const double step = alpha_1 / rho_1;
  if (!is_credible(step)) {
    return;
  }
  combine(count, -step, level.first_image, 1, level.r);
  const double after = host::sum(hierarchy_.ranks(depth), own_dot(level.r, level.r, count));
  if (after <= kGoodShare * kGoodShare * before) {
    combine(count, step, level.z, 0, level.z);
    return;
  }
  std::swap(level.first, level.z);
  const double more_work = descend(depth);
  // Braces keep the order: z's image is needed for one number only, and first_image for one before.
  const auto [gamma, alpha_2, beta] =
      host::sum(hierarchy_.ranks(depth), std::array{own_dot(level.z, level.first_image, count),
                                                    more_work, apply(depth, level.first_image)});
  const double rho_2 = beta - gamma * gamma / rho_1;
  if (is_credible(alpha_2 / rho_2)) {
    combine(count, alpha_2 / rho_2, level.z, step - gamma * alpha_2 / (rho_1 * rho_2), level.first);
  } else {
    combine(count, step, level.first, 0, level.first);
  }
  std::swap(level.first, level.z);  // Only z's own memory is kept while the finest z is made.
}

/// Solves the coarsest level by factors of K; in double precision their error is found spring by
/// spring, and corrected.
template <class Real>
void Cycle<Real>::solve_coarsest() {
  Level<Real>& level = hierarchy_.levels().back();
  std::fill(level.z.begin(), level.z.end(), Six<Real>{});
  add_coarsest(level.r, level.z);
  for (int step = 0; step < kCoarsestRefinementCount<Real>; ++step) {
    apply(hierarchy_.levels().size() - 1, level.first_image);
    combine(level.node_count, 1, level.r, -1, level.first_image);
    add_coarsest(level.first_image, level.z);
  }
}

/// z += K^-1 r
template <class Real>
void Cycle<Real>::add_coarsest(Vector r, Vector z) {
  const std::size_t count = hierarchy_.levels().back().node_count;
  coarsest_.resize(count);
  for (std::size_t node = 0; node < count; ++node) {
    for (std::size_t i = 0; i < 6; ++i) {
      coarsest_[node][i] = static_cast<double>(r[node].v[i]);
    }
  }
  hierarchy_.coarsest().solve(coarsest_);
  for (std::size_t node = 0; node < count; ++node) {
    for (std::size_t i = 0; i < 6; ++i) {
      z[node].v[i] += static_cast<Real>(coarsest_[node][i]);
    }
  }
}

/// image = K z; returns this rank's part of z . image.
template <class Real>
double Cycle<Real>::apply(std::size_t depth, Vector image) {
  Level<Real>& level = hierarchy_.levels()[depth];
  return team_.sum(level.node_count, [&](std::size_t begin, std::size_t end) {
    return kernels<Real>().apply_cluster(level.view(), level.z.data(), image.data(), {begin, end});
  });
}

/// This rank's part of a . b.
template <class Real>
double Cycle<Real>::own_dot(Vector a, Vector b, std::size_t count) {
  return team_.sum(count, [&](std::size_t begin, std::size_t end) {
    return kernels<Real>().dot_same(a.data(), b.data(), {begin, end});
  });
}

/// y = factor x + other y
template <class Real>
void Cycle<Real>::combine(std::size_t count, double factor, Vector x, double other, Vector y) {
  team_.share(0, count, [&](std::size_t begin, std::size_t end) {
    kernels<Real>().combine(static_cast<Real>(factor), x.data(), static_cast<Real>(other), y.data(),
                            {begin, end});
  });
}

template class Cycle<float>;
template class Cycle<double>;

}  // namespace holdfast::solver
