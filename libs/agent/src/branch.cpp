// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/branch.hpp"

#include <span>

#include "holdfast/base/check.hpp"
#include "scalar.hpp"

namespace holdfast::agent {
namespace {

using base::Direction;
using base::Mat6;
using base::Vec6;
using mechanics::BeamStiffness;

constexpr int kSize = 6;
constexpr int kOnto = 6;                        // First column of B', ...
constexpr int kAcross = kOnto + 6 * kLoopsMax;  // ... C' ...
constexpr int kGive = kAcross + 6 * kLoopsMax;  // ... and P'.

std::size_t at(int i) { return static_cast<std::size_t>(i); }

template <class Real>
Vec6<double> product(const Mat6<Real>& a, const Vec6<double>& x) {
  Vec6<double> y{};
  for (int column = 0; column < kSize; ++column) {
    for (int row = 0; row < kSize; ++row) {
      y[at(row)] += static_cast<double>(a.at(row, column)) * x[at(column)];
    }
  }
  return y;
}

template <class Real>
Vec6<double> transposed_product(const Mat6<Real>& a, const Vec6<double>& x) {
  Vec6<double> y{};
  for (int column = 0; column < kSize; ++column) {
    for (int row = 0; row < kSize; ++row) {
      y[at(column)] += static_cast<double>(a.at(row, column)) * x[at(row)];
    }
  }
  return y;
}

Vec6<double> unit(int i) {
  Vec6<double> vector{};
  vector[at(i)] = 1;
  return vector;
}

/// a times the unit vector `j`.
template <class Real>
Vec6<double> column_of(const Mat6<Real>& a, int j) {
  Vec6<double> column;
  for (int row = 0; row < kSize; ++row) {
    column[at(row)] = static_cast<double>(a.at(row, j));
  }
  return column;
}

void set_column(Mat6<double>& a, int j, const Vec6<double>& column) {
  for (int row = 0; row < kSize; ++row) {
    a.at(row, j) = column[at(row)];
  }
}

Mat6<double> converted(const Mat6<float>& a) {
  Mat6<double> result;
  for (std::size_t i = 0; i < a.values.size(); ++i) {
    result.values[i] = static_cast<double>(a.values[i]);
  }
  return result;
}

void subtract(Vec6<double>& from, const Vec6<double>& what) {
  for (std::size_t i = 0; i < kSize; ++i) {
    from[i] -= what[i];
  }
}

/// into += factor a q c, all 6x6.
void add_product(Mat6<float>& into, double factor, const Mat6<float>& a, const Mat6<float>& q,
                 const Mat6<float>& c) {
  for (int column = 0; column < kSize; ++column) {
    const Vec6<double> image = product(a, product(q, column_of(c, column)));
    for (int row = 0; row < kSize; ++row) {
      into.at(row, column) += static_cast<float>(factor * image[at(row)]);
    }
  }
}

/// A beam's end at the child: its flexibility, and the parent's motion there.
struct Joint {
  Joint(const BeamStiffness<double>& stiffness, Direction to_parent)
      : beam(stiffness),
        direction(to_parent),
        transport(rigid_transport(2 * beam.couple_x / beam.shear_x, to_parent)) {}  // c/s = L/2

  /// F = K11^-1: in the local frame two 2x2 blocks and two numbers.
  Vec6<double> bend(const Vec6<double>& force) const {
    const Vec6<double> local = mechanics::to_local(direction, force);
    const double x = beam.shear_x * beam.bend_x - beam.couple_x * beam.couple_x;
    const double y = beam.shear_y * beam.bend_y - beam.couple_y * beam.couple_y;
    return mechanics::to_global<double>(
        direction,
        {(beam.bend_x * local[0] + beam.couple_x * local[4]) / x,
         (beam.bend_y * local[1] - beam.couple_y * local[3]) / y, local[2] / beam.axial,
         (beam.shear_y * local[3] - beam.couple_y * local[1]) / y,
         (beam.shear_x * local[4] + beam.couple_x * local[0]) / x, local[5] / beam.twist});
  }

  const BeamStiffness<double>& beam;
  Direction direction;
  Mat6<double> transport;
};

/// Solves a x = b with pivots for every b, in place; a is used up.
void solve_all(Mat6<double>& a, std::span<Vec6<double>> right) {
  for (int column = 0; column < kSize; ++column) {
    int pivot = column;
    for (int row = column + 1; row < kSize; ++row) {
      pivot = absolute(a.at(row, column)) > absolute(a.at(pivot, column)) ? row : pivot;
    }
    for (int k = column; k < kSize && pivot != column; ++k) {
      const double kept = a.at(pivot, k);
      a.at(pivot, k) = a.at(column, k);
      a.at(column, k) = kept;
    }
    for (Vec6<double>& b : right) {
      const double kept = b[at(pivot)];
      b[at(pivot)] = b[at(column)];
      b[at(column)] = kept;
    }
    for (int row = column + 1; row < kSize; ++row) {
      const double factor = a.at(row, column) / a.at(column, column);
      if (factor == 0) {
        continue;
      }
      for (int k = column; k < kSize; ++k) {
        a.at(row, k) -= factor * a.at(column, k);
      }
      for (Vec6<double>& b : right) {
        b[at(row)] -= factor * b[at(column)];
      }
    }
  }
  for (Vec6<double>& b : right) {
    for (int row = kSize - 1; row >= 0; --row) {
      for (int k = row + 1; k < kSize; ++k) {
        b[at(row)] -= a.at(row, k) * b[at(k)];
      }
      b[at(row)] /= a.at(row, row);
    }
  }
}

/// 1 + S F
template <class Real>
Mat6<double> series(const Mat6<Real>& stiffness, const Joint& joint) {
  Mat6<double> sum;
  for (int column = 0; column < kSize; ++column) {
    const Vec6<double> image = product(stiffness, joint.bend(unit(column)));
    for (int row = 0; row < kSize; ++row) {
      sum.at(row, column) = image[at(row)] + (row == column ? 1 : 0);
    }
  }
  return sum;
}

/// 1 + F S, or transposed 1 + S^t F.
template <class Real>
Mat6<double> series_at_child(const Mat6<Real>& stiffness, const Joint& joint,
                             bool is_transposed = false) {
  Mat6<double> sum;
  for (int column = 0; column < kSize; ++column) {
    const Vec6<double> image = joint.bend(column_of(stiffness, column));
    for (int row = 0; row < kSize; ++row) {
      const double value = image[at(row)] + (row == column ? 1 : 0);
      (is_transposed ? sum.at(column, row) : sum.at(row, column)) = value;
    }
  }
  return sum;
}

/// Does nothing below touch the ground? Then F does not matter: the forces follow from the loads.
template <class Real>
bool is_free(const Mat6<Real>& stiffness) {
  for (const Real value : stiffness.values) {
    if (value != 0) {
      return false;
    }
  }
  return true;
}

/// N v = (1 + S F)^-1 v
template <class Real>
Vec6<double> through(const Mat6<Real>& stiffness, const Joint& joint, Vec6<double> vector) {
  if (!is_free(stiffness)) {
    Mat6<double> sum = series(stiffness, joint);
    solve_all(sum, {&vector, 1});
  }
  return vector;
}

/// G v = (1 + F S)^-1 v, or transposed.
template <class Real>
Vec6<double> through_at_child(const Mat6<Real>& stiffness, const Joint& joint, Vec6<double> vector,
                              bool is_transposed = false) {
  if (!is_free(stiffness)) {
    Mat6<double> sum = series_at_child(stiffness, joint, is_transposed);
    solve_all(sum, {&vector, 1});
  }
  return vector;
}

struct Entry {
  int row = 0;
  int column = 0;
};

constexpr int kTriangle = kSize * (kSize + 1) / 2;

/// Entry `place` of a lower triangle, column by column.
Entry lower_entry(int place) {
  Entry entry;
  for (int i = 0; i < place; ++i) {
    const bool is_last = entry.row + 1 == kSize;
    entry.column += is_last ? 1 : 0;
    entry.row = is_last ? entry.column : entry.row + 1;
  }
  return entry;
}

}  // namespace

bool is_symmetric(const Mat6<float>& stiffness) {
  constexpr double kRounding = 1e-5;
  const auto entry = [&](int row, int column) {
    return static_cast<double>(stiffness.at(row, column));
  };
  for (int column = 0; column < kSize; ++column) {
    for (int row = column + 1; row < kSize; ++row) {
      const double apart = entry(row, column) - entry(column, row);
      const double size = absolute(entry(row, row) * entry(column, column));
      if (apart * apart > kRounding * kRounding * size) {
        return false;
      }
    }
  }
  return true;
}

Vec6<float> part_of(const Mat6<float>& stiffness, int index) {
  Vec6<float> part{};
  for (int i = 0; i < kSize && kSize * index + i < kTriangle; ++i) {
    const Entry entry = lower_entry(kSize * index + i);
    part[at(i)] = stiffness.at(entry.row, entry.column);
  }
  return part;
}

Mat6<double> rigid_transport(double pitch_mm, Direction direction) {
  const base::Cell step = base::neighbour({0, 0, 0}, direction);
  const double x = -pitch_mm * step.x;
  const double y = -pitch_mm * step.y;
  const double z = -pitch_mm * step.z;
  Mat6<double> transport;
  for (int i = 0; i < kSize; ++i) {
    transport.at(i, i) = 1;
  }
  // The neighbour's rotation times the way from it to here.
  transport.at(0, 4) = z;
  transport.at(0, 5) = -y;
  transport.at(1, 3) = -z;
  transport.at(1, 5) = x;
  transport.at(2, 3) = y;
  transport.at(2, 4) = -x;
  return transport;
}

Mat6<double> stiffness_up(const BeamStiffness<double>& beam, Direction to_parent,
                          const Mat6<double>& stiffness) {
  if (is_free(stiffness)) {
    return {};
  }
  const Joint joint(beam, to_parent);
  Mat6<double> sum = series(stiffness, joint);
  std::array<Vec6<double>, kSize> forces;
  for (int column = 0; column < kSize; ++column) {
    forces[at(column)] = product(stiffness, column_of(joint.transport, column));
  }
  solve_all(sum, forces);
  Mat6<double> up;
  for (int column = 0; column < kSize; ++column) {
    set_column(up, column, transposed_product(joint.transport, forces[at(column)]));
  }
  return up;
}

Vec6<double> load_up(const BeamStiffness<double>& beam, Direction to_parent,
                     const Mat6<double>& stiffness, const Vec6<double>& load) {
  const Joint joint(beam, to_parent);
  return transposed_product(joint.transport, through(stiffness, joint, load));
}

Vec6<double> displacement(const BeamStiffness<double>& beam, Direction to_parent,
                          const Mat6<double>& stiffness, const Vec6<double>& of_parent,
                          const Vec6<double>& load) {
  const Joint joint(beam, to_parent);
  Vec6<double> sum = product(joint.transport, of_parent);
  base::add_to(sum, joint.bend(load));
  return through_at_child(stiffness, joint, sum);
}

Vec6<double> solve_general(Mat6<double> a, Vec6<double> b) {
  solve_all(a, {&b, 1});
  return b;
}

int Branch::meet(const Cut& cut) {
  const int slot = find(cut);
  if (slot >= 0) {
    open_ = static_cast<std::uint8_t>(open_ & ~(1U << static_cast<unsigned>(slot)));
    return slot;
  }
  if (count_ == kLoopsMax) {
    return -1;
  }
  cuts_[count_] = cut;
  open_ = static_cast<std::uint8_t>(open_ | (1U << count_));
  return count_++;
}

int Branch::find(const Cut& cut) const {
  for (int slot = 0; slot < count_; ++slot) {
    if (cuts_[at(slot)] == cut) {
      return slot;
    }
  }
  return -1;
}

int Branch::open_count() const {
  int count = 0;
  for (int slot = 0; slot < count_; ++slot) {
    count += is_open(slot) ? 1 : 0;
  }
  return count;
}

int Branch::open_slot(int i) const {
  for (int slot = 0; slot < count_; ++slot) {
    if (is_open(slot) && i-- == 0) {
      return slot;
    }
  }
  return -1;
}

void Branch::clear_stiffness() {
  stiffness_ = {};
  onto_ = {};
  across_ = {};
  give_ = {};
}

void Branch::add_stiffness(const Mat6<double>& block) {
  for (std::size_t i = 0; i < block.values.size(); ++i) {
    stiffness_.values[i] += static_cast<float>(block.values[i]);
  }
}

void Branch::add_end(int slot, bool is_upper, const Mat6<double>& transport) {
  for (int row = 0; row < kSize; ++row) {
    for (int column = 0; column < kSize; ++column) {
      const double one = row == column ? 1 : 0;
      onto_[at(slot)].at(row, column) +=
          static_cast<float>(is_upper ? -transport.at(column, row) : one);
      across_[at(slot)].at(row, column) +=
          static_cast<float>(is_upper ? -transport.at(row, column) : one);
    }
  }
}

void Branch::add_column(int index, const std::array<std::int8_t, kLoopsMax>& slot_of,
                        const Vec6<float>& column) {
  Mat6<float>* block = &stiffness_;
  bool is_row = false;
  if (index >= kGive) {
    const int pair = (index - kGive) / kSize;
    block = &give_[at(slot_of[at(pair / kLoopsMax)])][at(slot_of[at(pair % kLoopsMax)])];
  } else if (index >= kAcross) {
    block = &across_[at(slot_of[at((index - kAcross) / kSize)])];
    is_row = true;
  } else if (index >= kOnto) {
    block = &onto_[at(slot_of[at((index - kOnto) / kSize)])];
  }
  for (int i = 0; i < kSize; ++i) {
    (is_row ? block->at(index % kSize, i) : block->at(i, index % kSize)) += column[at(i)];
  }
}

void Branch::add_part(int index, const Vec6<float>& part) {
  for (int i = 0; i < kSize && kSize * index + i < kTriangle; ++i) {
    const Entry entry = lower_entry(kSize * index + i);
    stiffness_.at(entry.row, entry.column) += part[at(i)];
    if (entry.row != entry.column) {
      stiffness_.at(entry.column, entry.row) += part[at(i)];
    }
  }
}

void Branch::close_loops(const BeamStiffness<double>& beam) {
  for (int slot = 0; slot < count_; ++slot) {
    if (is_open(slot)) {
      continue;
    }
    // Q = (P + F)^-1 = (K P + 1)^-1 K
    Mat6<float>& give = give_[at(slot)][at(slot)];
    const Mat6<double> stiffness = mechanics::block_11(beam, cuts_[at(slot)].direction);
    Mat6<double> sum;
    for (int column = 0; column < kSize; ++column) {
      const Vec6<double> image = product(stiffness, column_of(give, column));
      for (int row = 0; row < kSize; ++row) {
        sum.at(row, column) = image[at(row)] + (row == column ? 1 : 0);
      }
    }
    for (int column = 0; column < kSize; ++column) {
      const Vec6<double> inverse = solve_general(sum, column_of(stiffness, column));
      for (int row = 0; row < kSize; ++row) {
        give.at(row, column) = static_cast<float>(inverse[at(row)]);
      }
    }
    add_product(stiffness_, 1, onto_[at(slot)], give, across_[at(slot)]);
    for (int other = 0; other < count_; ++other) {
      if (!is_closed_after(slot, other)) {
        continue;
      }
      const Mat6<float>& here = give_[at(slot)][at(other)];
      const Mat6<float>& there = give_[at(other)][at(slot)];
      add_product(onto_[at(other)], -1, onto_[at(slot)], give, here);
      add_product(across_[at(other)], -1, there, give, across_[at(slot)]);
      add_product(give_[at(other)][at(other)], -1, there, give, here);
    }
  }
}

int Branch::columns_needed(int index, const std::array<std::int8_t, kLoopsMax>& slot_of,
                           int child_loops) const {
  const auto of_child = [&](int open) {
    for (int i = 0; i < child_loops; ++i) {
      if (open >= 0 && slot_of[at(i)] == open_slot(open)) {
        return i;
      }
    }
    return -1;
  };
  const int j = index % kSize;
  if (index < kOnto) {
    return kOnto;
  }
  if (index < kGive) {
    const int first = index < kAcross ? kOnto : kAcross;
    const int loop = of_child((index - first) / kSize);
    return loop < 0 ? kOnto : first + kSize * loop + j + 1;
  }
  const int pair = (index - kGive) / kSize;
  const int row = of_child(pair / kLoopsMax);
  const int column = of_child(pair % kLoopsMax);
  return row < 0 || column < 0 ? kGive : kGive + kSize * (kLoopsMax * row + column) + j + 1;
}

Mat6<double> Branch::stiffness_up(const BeamStiffness<double>& beam, Direction to_parent,
                                  bool is_fixed) const {
  if (!is_fixed) {
    return agent::stiffness_up(beam, to_parent, converted(stiffness_));
  }
  const Mat6<double> transport = Joint(beam, to_parent).transport;
  const Mat6<double> block = mechanics::block_11(beam, to_parent);
  Mat6<double> up;
  for (int column = 0; column < kSize; ++column) {
    set_column(up, column,
               transposed_product(transport, product(block, column_of(transport, column))));
  }
  return up;
}

Vec6<double> Branch::column_up(const BeamStiffness<double>& beam, Direction to_parent,
                               bool is_fixed, int index) const {
  HOLDFAST_ASSERT(index >= kOnto);
  const Joint joint(beam, to_parent);
  const int j = index % kSize;
  if (index < kGive) {
    const bool is_onto = index < kAcross;
    const int slot = open_slot((index - (is_onto ? kOnto : kAcross)) / kSize);
    if (slot < 0 || is_fixed) {
      return {};
    }
    if (is_onto) {
      return transposed_product(joint.transport,
                                through(stiffness_, joint, column_of(onto_[at(slot)], j)));
    }
    Vec6<double> row;
    for (int i = 0; i < kSize; ++i) {
      row[at(i)] = static_cast<double>(across_[at(slot)].at(j, i));
    }
    return transposed_product(joint.transport, through_at_child(stiffness_, joint, row, true));
  }
  const int row = open_slot((index - kGive) / kSize / kLoopsMax);
  const int column = open_slot((index - kGive) / kSize % kLoopsMax);
  if (row < 0 || column < 0) {
    return {};
  }
  Vec6<double> sum = column_of(give_[at(row)][at(column)], j);
  if (!is_fixed) {
    const Vec6<double> bent = joint.bend(column_of(onto_[at(column)], j));
    base::add_to(sum, product(across_[at(row)], through_at_child(stiffness_, joint, bent)));
  }
  return sum;
}

void Branch::close_loops(BranchLoad& load) const {
  for (int slot = 0; slot < count_; ++slot) {
    if (is_open(slot)) {
      continue;
    }
    const Vec6<double> force = product(give_[at(slot)][at(slot)], load.gap[at(slot)]);
    subtract(load.load, product(onto_[at(slot)], force));
    for (int other = 0; other < count_; ++other) {
      if (is_closed_after(slot, other)) {
        subtract(load.gap[at(other)], product(give_[at(other)][at(slot)], force));
      }
    }
  }
}

BranchLoad Branch::load_up(const BeamStiffness<double>& beam, Direction to_parent, bool is_fixed,
                           const BranchLoad& load) const {
  const Joint joint(beam, to_parent);
  BranchLoad up;
  for (int i = 0; i < open_count(); ++i) {
    up.gap[at(i)] = load.gap[at(open_slot(i))];
  }
  if (is_fixed) {
    return up;
  }
  up.load = transposed_product(joint.transport, through(stiffness_, joint, load.load));
  for (int i = 0; i < open_count(); ++i) {
    base::add_to(up.gap[at(i)],
                 product(across_[at(open_slot(i))],
                         through_at_child(stiffness_, joint, joint.bend(load.load))));
  }
  return up;
}

Vec6<double> Branch::displacement(const BeamStiffness<double>& beam, Direction to_parent,
                                  const Vec6<double>& of_parent, const BranchLoad& load,
                                  CutForces& forces) const {
  const Joint joint(beam, to_parent);
  Vec6<double> carried = load.load;
  for (int slot = 0; slot < count_; ++slot) {
    if (is_open(slot)) {
      subtract(carried, product(onto_[at(slot)], forces[at(slot)]));
    }
  }
  Vec6<double> sum = product(joint.transport, of_parent);
  base::add_to(sum, joint.bend(carried));
  const Vec6<double> u = through_at_child(stiffness_, joint, sum);
  find_forces(load, u, forces);
  return u;
}

Vec6<double> Branch::displacement_of_root(const BranchLoad& load, CutForces& forces) const {
  const Vec6<double> u = solve_general(converted(stiffness_), load.load);
  find_forces(load, u, forces);
  return u;
}

void Branch::find_forces(const BranchLoad& load, const Vec6<double>& u, CutForces& forces) const {
  for (int slot = count_ - 1; slot >= 0; --slot) {
    if (is_open(slot)) {
      continue;
    }
    Vec6<double> gap = load.gap[at(slot)];
    base::add_to(gap, product(across_[at(slot)], u));
    for (int other = 0; other < count_; ++other) {
      if (is_closed_after(slot, other)) {
        subtract(gap, product(give_[at(slot)][at(other)], forces[at(other)]));
      }
    }
    forces[at(slot)] = product(give_[at(slot)][at(slot)], gap);
  }
}

}  // namespace holdfast::agent
