// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/algebra/branch.hpp"

#include "algebra/scalar.hpp"
#include "holdfast/agent/algebra/system.hpp"
#include "holdfast/base/check.hpp"

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

/// y += a x. Zeros in x, of which there are many, cost nothing.
void add_product(Vec6<double>& y, const Mat6<float>& a, const Vec6<double>& x) {
  for (int column = 0; column < kSize; ++column) {
    if (x[at(column)] == 0) {
      continue;
    }
    for (int row = 0; row < kSize; ++row) {
      y[at(row)] += static_cast<double>(a.at(row, column)) * x[at(column)];
    }
  }
}

Vec6<double> product(const Mat6<float>& a, const Vec6<double>& x) {
  Vec6<double> y{};
  add_product(y, a, x);
  return y;
}

Vec6<double> unit(int i) {
  Vec6<double> vector{};
  vector[at(i)] = 1;
  return vector;
}

Vec6<double> column_of(const Mat6<float>& a, int j) {
  Vec6<double> column;
  for (int row = 0; row < kSize; ++row) {
    column[at(row)] = static_cast<double>(a.at(row, j));
  }
  return column;
}

Vec6<double> row_of(const Mat6<float>& a, int i) {
  Vec6<double> row;
  for (int column = 0; column < kSize; ++column) {
    row[at(column)] = static_cast<double>(a.at(i, column));
  }
  return row;
}

void subtract(Vec6<double>& from, const Vec6<double>& what) {
  for (std::size_t i = 0; i < kSize; ++i) {
    from[i] -= what[i];
  }
}

/// into -= x in column `column`.
void subtract_column(Mat6<float>& into, int column, const Vec6<double>& x) {
  for (int row = 0; row < kSize; ++row) {
    into.at(row, column) -= static_cast<float>(x[at(row)]);
  }
}

/// into -= a x in column `column`.
[[gnu::noinline]] void subtract_product(Mat6<float>& into, int column, const Mat6<float>& a,
                                        const Vec6<double>& x) {
  subtract_column(into, column, product(a, x));
}

/// Does nothing below touch the ground? Then F does not matter: the forces follow from the loads.
bool is_free(const Mat6<float>& stiffness) {
  for (const float value : stiffness.values) {
    if (value != 0) {
      return false;
    }
  }
  return true;
}

/// Springs in series with a beam.
enum class Series : std::uint8_t {
  kAtParent,    // N = (1 + S F)^-1
  kAtChild,     // G = (1 + F S)^-1
  kTransposed,  // G^t
};

class InSeries {
 public:
  InSeries(const Mat6<float>& stiffness, const Joint& joint, Series series)
      : is_one_(is_free(stiffness)) {
    if (!is_one_) {
      factor(stiffness, joint, series);
    }
  }

  /// N v, G v or G^t v, in place.
  void pass(Vec6<double>& vector) const {
    if (!is_one_) {
      system_.solve(vector);
    }
  }

 private:
  [[gnu::noinline]] void factor(const Mat6<float>& stiffness, const Joint& joint, Series series) {
    // F is symmetric: S F has F times S's rows as its rows.
    for (int i = 0; i < kSize; ++i) {
      Vec6<double> line =
          series == Series::kAtParent ? row_of(stiffness, i) : column_of(stiffness, i);
      joint.bend(line);
      line[at(i)] += 1;
      for (int k = 0; k < kSize; ++k) {
        (series == Series::kAtChild ? system_.at(k, i) : system_.at(i, k)) = line[at(k)];
      }
    }
    system_.factor();
  }

  System system_;
  bool is_one_;
};

using Columns = Branch::Columns;
using Which = std::array<std::uint8_t, Branch::kBatch>;

/// v = S T e_j
[[gnu::noinline]] void force_of_unit(const Joint& joint, const Mat6<float>& stiffness, int j,
                                     Vec6<double>& v) {
  Vec6<double> moved = unit(j);
  joint.carry(moved);
  v = {};
  add_product(v, stiffness, moved);
}

/// Columns of T^t N S T.
void condense(const Joint& joint, const Mat6<float>& stiffness, const Which& which,
              Columns& columns) {
  const InSeries series(stiffness, joint, Series::kAtParent);
  Vec6<double> force;
  for (std::size_t i = 0; i < which.size(); ++i) {
    force_of_unit(joint, stiffness, which[i], force);
    series.pass(force);
    joint.hand_on(force);
    columns[i] = base::converted<float>(force);
  }
}

Which three_from(int first) {
  const auto j = static_cast<std::uint8_t>(first % kSize);
  return {j, static_cast<std::uint8_t>(j + 1), static_cast<std::uint8_t>(j + 2)};
}

}  // namespace

/// F is, in the local frame, two 2x2 blocks and two numbers.
Joint::Joint(Beams<double> beams, Direction direction) : beams_(beams), direction_(direction) {
  const BeamStiffness<double>& beam = stiffness_of(beams);
  const double pitch = 2 * beam.couple_x / beam.shear_x;  // c/s = L/2
  lever_ = lever_across(beams, direction, pitch);
  const double x = 1 / (beam.shear_x * beam.bend_x - beam.couple_x * beam.couple_x);
  const double y = 1 / (beam.shear_y * beam.bend_y - beam.couple_y * beam.couple_y);
  straight_ = {beam.bend_x * x,  beam.bend_y * y,  1 / beam.axial,
               beam.shear_y * y, beam.shear_x * x, 1 / beam.twist};
  across_x_ = beam.couple_x * x;
  across_y_ = -beam.couple_y * y;
}

void Joint::bend(Vec6<double>& force) const {
  Vec6<double> local = to_local(beams_, direction_, force);
  const double fx = local[0];
  const double fy = local[1];
  local[0] = straight_[0] * fx + across_x_ * local[4];
  local[1] = straight_[1] * fy + across_y_ * local[3];
  local[2] *= straight_[2];
  local[3] = straight_[3] * local[3] + across_y_ * fy;
  local[4] = straight_[4] * local[4] + across_x_ * fx;
  local[5] *= straight_[5];
  force = to_global(beams_, direction_, local);
}

void Joint::hold(Vec6<double>& u) const { u = end_force(beams_, direction_, u, Vec6<double>{}); }

void Joint::carry(Vec6<double>& u) const {
  u[0] += lever_[2] * u[4] - lever_[1] * u[5];
  u[1] += lever_[0] * u[5] - lever_[2] * u[3];
  u[2] += lever_[1] * u[3] - lever_[0] * u[4];
}

void Joint::hand_on(Vec6<double>& force) const {
  force[3] += lever_[1] * force[2] - lever_[2] * force[1];
  force[4] += lever_[2] * force[0] - lever_[0] * force[2];
  force[5] += lever_[0] * force[1] - lever_[1] * force[0];
}

void find_stiffness_up(const Joint& to_parent, const Mat6<float>& stiffness, int first,
                       Columns& columns) {
  condense(to_parent, stiffness, three_from(first), columns);
}

void find_load_up(const Joint& to_parent, const Mat6<float>& stiffness, Vec6<double>& load) {
  InSeries(stiffness, to_parent, Series::kAtParent).pass(load);
  to_parent.hand_on(load);
}

void find_displacement(const Joint& to_parent, const Mat6<float>& stiffness, Vec6<double>& load,
                       Vec6<double>& u) {
  to_parent.carry(u);
  to_parent.bend(load);
  base::add_to(u, load);
  InSeries(stiffness, to_parent, Series::kAtChild).pass(u);
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

int Branch::loops_of_column(int index) {
  if (index < kOnto || index >= kColumnCount) {
    return 0;
  }
  if (index < kGive) {
    return 1 + (index - kOnto) / kSize % kLoopsMax;
  }
  const int pair = (index - kGive) / kSize;
  const int row = pair / kLoopsMax;
  const int column = pair % kLoopsMax;
  return 1 + (row > column ? row : column);
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

/// B = C = 1, or B = -T^t, C = -T.
void Branch::add_end(int slot, bool is_upper, Beams<double> beams) {
  const Joint joint(beams, cuts_[at(slot)].direction);
  for (int column = 0; column < kSize; ++column) {
    Vec6<double> moved = unit(column);
    if (is_upper) {
      joint.carry(moved);
    }
    for (int row = 0; row < kSize; ++row) {
      const auto value = static_cast<float>(is_upper ? -moved[at(row)] : moved[at(row)]);
      across_[at(slot)].at(row, column) += value;
      onto_[at(slot)].at(column, row) += value;
    }
  }
}

void Branch::add_column(int index, const std::array<std::uint8_t, kLoopsMax>& slot_of,
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

void add_part(Mat6<float>& into, int index, const Vec6<float>& part) {
  const auto add = [&](int row, int column, float value) {
    into.at(row, column) += value;
    if (row != column) {
      into.at(column, row) += value;
    }
  };
  for (int row = index; row < kSize; ++row) {
    add(row, index, part[at(row - index)]);
  }
  for (int row = kSize - index; row < kSize && index < Branch::kPartCount - 1; ++row) {
    add(row, kSize - index, part[at(row)]);
  }
}

bool Branch::close_loops(Beams<double> beams, std::uint8_t& piece) {
  constexpr int kPieces = 1 + kSize;
  while (piece < kPieces * count_) {
    const int slot = piece / kPieces;
    const int part = piece % kPieces;
    ++piece;
    if (is_open(slot)) {
      continue;
    }
    part == 0 ? close_loop(beams, slot) : close_column(slot, part - 1);
    return true;
  }
  return false;
}

/// Q = (P + F)^-1 instead of P.
void Branch::close_loop(Beams<double> beams, int slot) {
  Mat6<float>& give = give_[at(slot)][at(slot)];
  const Joint joint(beams, cuts_[at(slot)].direction);
  System sum;
  for (int column = 0; column < kSize; ++column) {
    Vec6<double> bent = unit(column);
    joint.bend(bent);
    for (int row = 0; row < kSize; ++row) {
      sum.at(row, column) = static_cast<double>(give.at(row, column)) + bent[at(row)];
    }
  }
  sum.factor();
  give = {};
  for (int column = 0; column < kSize; ++column) {
    Vec6<double> inverse{};
    inverse[at(column)] = -1;
    sum.solve(inverse);
    subtract_column(give, column, inverse);
  }
}

/// Column `column` of what the force X = Q (y + C u) of a closed loop does to the others.
void Branch::close_column(int slot, int column) {
  const Mat6<float>& give = give_[at(slot)][at(slot)];
  const Mat6<float>& onto = onto_[at(slot)];
  for (int other = 0; other < count_; ++other) {
    if (!is_closed_after(slot, other)) {
      continue;
    }
    const Mat6<float>& there = give_[at(other)][at(slot)];
    Vec6<double> force = product(give, column_of(across_[at(slot)], column));
    subtract_product(across_[at(other)], column, there, force);
    force = product(give, column_of(give_[at(slot)][at(other)], column));
    subtract_product(onto_[at(other)], column, onto, force);
    subtract_product(give_[at(other)][at(other)], column, there, force);
  }
  Vec6<double> force = product(give, column_of(across_[at(slot)], column));
  for (double& value : force) {
    value = -value;
  }
  subtract_product(stiffness_, column, onto, force);
}

int Branch::columns_needed(int index, const std::array<std::uint8_t, kLoopsMax>& slot_of,
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

bool Branch::has_columns(int index, bool is_fixed) const {
  const int pair = (index - kGive) / kSize;
  return index < kOnto     ? is_fixed || !is_free(stiffness_)
         : index < kAcross ? !is_fixed && open_slot((index - kOnto) / kSize) >= 0
         : index < kGive   ? !is_fixed && open_slot((index - kAcross) / kSize) >= 0
                           : open_slot(pair / kLoopsMax) >= 0 && open_slot(pair % kLoopsMax) >= 0;
}

bool Branch::is_symmetric() const {
  constexpr float kRounding = 1e-5F;
  for (int column = 0; column < kSize; ++column) {
    for (int row = column + 1; row < kSize; ++row) {
      const float apart = stiffness_.at(row, column) - stiffness_.at(column, row);
      const float size = stiffness_.at(row, row) * stiffness_.at(column, column);
      if (apart * apart > kRounding * kRounding * size) {
        return false;
      }
    }
  }
  return true;
}

void Branch::find_stiffness_up(const Joint& to_parent, bool is_fixed, const Which& which,
                               Columns& columns) const {
  if (!is_fixed) {
    condense(to_parent, stiffness_, which, columns);
    return;
  }
  for (std::size_t i = 0; i < which.size(); ++i) {
    Vec6<double> force = unit(which[i]);
    to_parent.carry(force);
    to_parent.hold(force);
    to_parent.hand_on(force);
    columns[i] = base::converted<float>(force);
  }
}

void Branch::find_columns_up(const Joint& to_parent, bool is_fixed, int first, int count,
                             Columns& columns) const {
  if (first < kOnto) {
    find_stiffness_up(to_parent, is_fixed, three_from(first), columns);
  } else if (first < kGive) {
    find_end_columns(to_parent, first, count, columns);
  } else {
    find_give_columns(to_parent, is_fixed, first, count, columns);
  }
}

/// B' = T^t N B or the transposed C' = C G T.
void Branch::find_end_columns(const Joint& to_parent, int first, int count,
                              Columns& columns) const {
  const bool is_onto = first < kAcross;
  const int slot = open_slot((first - (is_onto ? kOnto : kAcross)) / kSize);
  HOLDFAST_ASSERT(slot >= 0);
  const InSeries series(stiffness_, to_parent, is_onto ? Series::kAtParent : Series::kTransposed);
  Vec6<double> vector;
  for (int i = 0; i < count; ++i) {
    const int j = first % kSize + i;
    vector = is_onto ? column_of(onto_[at(slot)], j) : row_of(across_[at(slot)], j);
    series.pass(vector);
    to_parent.hand_on(vector);
    columns[at(i)] = base::converted<float>(vector);
  }
}

/// P' = P + C G F B
void Branch::find_give_columns(const Joint& to_parent, bool is_fixed, int first, int count,
                               Columns& columns) const {
  const int row = open_slot((first - kGive) / kSize / kLoopsMax);
  const int column = open_slot((first - kGive) / kSize % kLoopsMax);
  HOLDFAST_ASSERT(row >= 0 && column >= 0);
  const Mat6<float>& give = give_[at(row)][at(column)];
  const int j = first % kSize;
  if (is_fixed) {
    for (int i = 0; i < count; ++i) {
      columns[at(i)] = base::converted<float>(column_of(give, j + i));
    }
    return;
  }
  const InSeries series(stiffness_, to_parent, Series::kAtChild);
  Vec6<double> bent;
  for (int i = 0; i < count; ++i) {
    bent = column_of(onto_[at(column)], j + i);
    to_parent.bend(bent);
    series.pass(bent);
    bent = product(across_[at(row)], bent);
    base::add_to(bent, column_of(give, j + i));
    columns[at(i)] = base::converted<float>(bent);
  }
}

void Branch::find_parts_up(const Joint& to_parent, bool is_fixed, int first,
                           Columns& columns) const {
  const auto i = static_cast<std::uint8_t>(first);
  // Column 6 - i for both parts; the first has none, the last only one.
  const Which which = first == 0 ? Which{0, 1, 5} : Which{i, static_cast<std::uint8_t>(i + 1), 4};
  find_stiffness_up(to_parent, is_fixed, which, columns);
  for (int part = first; part < first + 2; ++part) {
    Vec6<float>& into = columns[at(part - first)];
    for (int row = 0; row < kSize; ++row) {
      into[at(row)] = row + part < kSize ? into[at(row + part)] : 0;
    }
    const int behind = kSize - part;
    for (int row = behind; row < kSize && behind == which[2]; ++row) {
      into[at(row)] = columns[2][at(row)];
    }
  }
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

void Branch::find_load_up(const Joint& to_parent, bool is_fixed, Vec6<double>& load) const {
  if (is_fixed) {
    load = {};
  } else {
    agent::find_load_up(to_parent, stiffness_, load);
  }
}

void Branch::find_gaps_up(const Joint& to_parent, bool is_fixed, const BranchLoad& load,
                          CutForces& gaps) const {
  Vec6<double> bent{};
  if (!is_fixed && open_count() > 0) {
    bent = load.load;
    to_parent.bend(bent);
    InSeries(stiffness_, to_parent, Series::kAtChild).pass(bent);
  }
  for (int i = 0; i < open_count(); ++i) {
    const auto slot = at(open_slot(i));
    Vec6<double> gap = load.gap[slot];
    add_product(gap, across_[slot], bent);
    gaps[at(i)] = base::converted<float>(gap);
  }
}

void Branch::find_displacement(const Joint& to_parent, const BranchLoad& load,
                               const CutForces& forces, Vec6<double>& u) const {
  Vec6<double> carried = load.load;
  for (int slot = 0; slot < count_; ++slot) {
    if (is_open(slot)) {
      subtract(carried, product(onto_[at(slot)], base::converted<double>(forces[at(slot)])));
    }
  }
  agent::find_displacement(to_parent, stiffness_, carried, u);
}

void Branch::find_displacement_of_root(const BranchLoad& load, Vec6<double>& u) const {
  System system;
  for (int column = 0; column < kSize; ++column) {
    for (int row = 0; row < kSize; ++row) {
      system.at(row, column) = static_cast<double>(stiffness_.at(row, column));
    }
  }
  system.factor();
  u = load.load;
  system.solve(u);
}

void Branch::find_forces(const BranchLoad& load, const Vec6<double>& u, CutForces& forces) const {
  for (int slot = count_ - 1; slot >= 0; --slot) {
    if (is_open(slot)) {
      continue;
    }
    Vec6<double> gap = load.gap[at(slot)];
    add_product(gap, across_[at(slot)], u);
    for (int other = 0; other < count_; ++other) {
      if (is_closed_after(slot, other)) {
        subtract(gap,
                 product(give_[at(slot)][at(other)], base::converted<double>(forces[at(other)])));
      }
    }
    forces[at(slot)] = base::converted<float>(product(give_[at(slot)][at(slot)], gap));
  }
}

}  // namespace holdfast::agent
