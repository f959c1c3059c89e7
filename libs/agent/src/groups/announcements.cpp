// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/groups/announcements.hpp"

namespace holdfast::agent {
namespace {

/// Can it be told? Neighbours refuse what is outside the lattice (messages.hpp).
bool is_legal(const base::Cell& cell) {
  for (const std::int32_t value : {cell.x, cell.y, cell.z}) {
    if (value < -base::kCoordinateMax || value > base::kCoordinateMax) {
      return cell == kEveryCell;
    }
  }
  return true;
}

}  // namespace

void Announcements::clear() {
  const Announcements before = *this;
  *this = Announcements();
  if (before.is_lent_) {
    *before.cells_.lent = {};
    lend(before.cells_.lent);
  }
}

bool operator==(const Announcements& one, const Announcements& other) {
  bool is_equal = one.count_ == other.count_ && one.lost_ == other.lost_;
  for (int i = 0; is_equal && i < one.count_; ++i) {
    is_equal = one.cell(i) == other.cell(i) && one.told(i) == other.told(i);
  }
  return is_equal;
}

int Announcements::find(const base::Cell& cell) const {
  for (int i = 0; i < count_; ++i) {
    if (cells()[static_cast<std::size_t>(i)] == cell) {
      return i;
    }
  }
  return -1;
}

/// What is told of a cell replaces what was told of it before.
void Announcements::put(const base::Cell& cell, Told told) {
  const int found = find(cell);
  const bool is_possible = is_legal(cell);
  if (!is_possible && told == Told::kWithdrawal) {
    return;
  }
  if (!is_possible || (found < 0 && count_ == static_cast<int>(tolds().size()))) {
    lost_ = Told::kPlan;
    return;
  }
  const auto i = static_cast<std::size_t>(found < 0 ? count_++ : found);
  cells()[i] = cell;
  tolds()[i] = told;
}

/// The last one takes its place; free places are empty, so that equal contents are equal.
void Announcements::erase(int i) {
  const auto last = static_cast<std::size_t>(--count_);
  cells()[static_cast<std::size_t>(i)] = cells()[last];
  tolds()[static_cast<std::size_t>(i)] = tolds()[last];
  cells()[last] = {};
  tolds()[last] = Told::kNothing;
}

void Announcements::plan(const base::Cell& cell) { recall(cell, Told::kPlan); }

void Announcements::withdraw(const base::Cell& cell) {
  if (cell == kEveryCell) {
    clear();
  }
  put(cell, Told::kWithdrawal);
}

void Announcements::recall(const base::Cell& cell, Told told) {
  if (cell == kEveryCell && !is_withdrawal(told)) {
    lost_ = told;
  } else {
    put(cell, is_withdrawal(told) ? Told::kWithdrawal : told);
  }
}

void Announcements::settle() {
  for (Told& told : tolds()) {
    told = told == Told::kPlan           ? Told::kKnownPlan
           : told == Told::kDisputedPlan ? Told::kKnownDispute
                                         : told;
  }
  lost_ = lost_ == Told::kPlan ? Told::kKnownPlan : lost_;
}

void Announcements::finish_forgetting() {
  for (int i = count_; i-- > 0;) {
    if (tolds()[static_cast<std::size_t>(i)] == Told::kCarriedWithdrawal) {
      erase(i);
    }
  }
}

void Announcements::begin_anew() {
  for (Told& told : tolds()) {
    told = is_withdrawal(told) ? Told::kWithdrawal : told;
  }
}

void Announcements::forget(const base::Cell& cell, bool is_fulfilled) {
  const bool is_every = cell == kEveryCell;
  for (int i = count_; i-- > 0;) {
    Told& told = tolds()[static_cast<std::size_t>(i)];
    if (!is_every && cells()[static_cast<std::size_t>(i)] != cell) {
      continue;
    }
    if (is_withdrawal(told)) {
      told = is_fulfilled ? told : Told::kCarriedWithdrawal;
    } else if (is_fulfilled || told == Told::kKnownPlan || told == Told::kKnownDispute) {
      erase(i);
    } else {
      told = Told::kDisputedPlan;
    }
  }
  if (is_every && lost_ == Told::kKnownPlan) {
    lost_ = Told::kNothing;
  }
}

int Announcements::plan_count() const {
  int plans = 0;
  for (int i = 0; i < count(); ++i) {
    plans += is_withdrawal(told(i)) ? 0 : 1;
  }
  return plans;
}

}  // namespace holdfast::agent
