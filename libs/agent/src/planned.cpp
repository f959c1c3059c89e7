// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/agent/planned.hpp"

namespace holdfast::agent {
namespace {

std::uint8_t bit(int i) { return static_cast<std::uint8_t>(1U << static_cast<unsigned>(i)); }

constexpr int kWholeSubtree = -1;

}  // namespace

void Planned::add(const base::Cell& cell, const base::Cell& self) {
  if (count_ == kPlannedMax) {
    return;
  }
  const auto i = static_cast<std::size_t>(count_++);
  cells_[i] = cell;
  own_face_[i] = -1;
  own_mask_[i] = 0;
  for (const base::Direction face : base::kDirections) {
    if (base::neighbour(self, face) == cell) {
      own_face_[i] = static_cast<std::int8_t>(base::index(face));
      own_mask_[i] = bit(base::index(base::opposite(face)));
    }
  }
}

void Planned::add_below(int face, int index, std::uint8_t mask) {
  if (index < count_) {
    below_[static_cast<std::size_t>(face)][static_cast<std::size_t>(index)] = mask;
  }
}

std::uint8_t Planned::mask(int index) const {
  const auto i = static_cast<std::size_t>(index);
  std::uint8_t mask = own_mask_[i];
  for (const auto& child : below_) {
    mask = static_cast<std::uint8_t>(mask | child[i]);
  }
  return mask;
}

/// Are all participants of a group below the child at `face`, or from this module down?
bool Planned::is_whole(std::uint8_t group, int face) const {
  for (int k = 0; k < count_; ++k) {
    const auto i = static_cast<std::size_t>(k);
    const std::uint8_t here =
        face == kWholeSubtree ? mask(k) : below_[static_cast<std::size_t>(face)][i];
    if (groups_[i] == group && here != totals_[i]) {
      return false;
    }
  }
  return true;
}

void Planned::decide_hosts(const std::array<std::uint8_t, 8>& totals) {
  hosted_count_ = 0;
  from_above_ = 0;
  involved_ = 0;
  is_any_remote_ = false;
  for (int k = 0; k < count_; ++k) {
    totals_[static_cast<std::size_t>(k)] = totals[static_cast<std::size_t>(k)];
    groups_[static_cast<std::size_t>(k)] = static_cast<std::uint8_t>(k);
  }
  // A group is named after its first module; names spread until nothing changes.
  for (int pass = 0; pass < count_; ++pass) {
    for (int k = 0; k < count_; ++k) {
      for (const base::Direction direction : base::kDirections) {
        const int other = neighbour_of(k, direction);
        if (other >= 0 && group_of(other) < group_of(k)) {
          groups_[static_cast<std::size_t>(k)] = group_of(other);
        }
      }
    }
  }
  for (int k = 0; k < count_; ++k) {
    const std::uint8_t group = group_of(k);
    // What touches nothing is whole below every face, so nobody hosts it.
    bool is_above = false;
    bool is_own_only = true;
    for (int face = 0; face < base::kDirectionCount; ++face) {
      is_above = is_above || is_whole(group, face);
      for (int other = 0; other < count_; ++other) {
        is_own_only =
            is_own_only &&
            !(group_of(other) == group &&
              below_[static_cast<std::size_t>(face)][static_cast<std::size_t>(other)] != 0);
      }
    }
    if (is_above) {
      continue;
    }
    if (is_whole(group, kWholeSubtree)) {
      hosted_[hosted_count_++] = static_cast<std::uint8_t>(k);
      involved_ = static_cast<std::uint8_t>(involved_ | bit(k));
      is_any_remote_ = is_any_remote_ || !is_own_only;
    } else if (mask(k) != 0) {
      from_above_ = static_cast<std::uint8_t>(from_above_ | bit(k));
      involved_ = static_cast<std::uint8_t>(involved_ | bit(k));
      is_any_remote_ = true;
    }
  }
}

bool Planned::agrees_with(const std::array<std::uint8_t, 8>& totals) const {
  for (int k = 0; k < count_; ++k) {
    if ((mask(k) & ~unsigned{totals[static_cast<std::size_t>(k)]}) != 0) {
      return false;
    }
  }
  return true;
}

int Planned::at_face(int face) const {
  for (int k = 0; k < count_; ++k) {
    if (own_face(k) == face) {
      return k;
    }
  }
  return -1;
}

int Planned::neighbour_of(int index, base::Direction direction) const {
  const base::Cell wanted = base::neighbour(cell(index), direction);
  for (int k = 0; k < count_; ++k) {
    if (cell(k) == wanted) {
      return k;
    }
  }
  return -1;
}

int Planned::node_of(int index) const {
  for (int i = 0; i < hosted_count_; ++i) {
    if (hosted(i) == index) {
      return 1 + i;
    }
  }
  return -1;
}

int Planned::slot_of(int index) const {
  const int node = node_of(index);
  if (node >= 0) {
    return node;
  }
  int slot = 1 + hosted_count_;
  for (int k = 0; k < index; ++k) {
    slot += is_from_above(k) ? 1 : 0;
  }
  return slot;
}

bool Planned::is_needed_below(int face, int index) const {
  return (involved_ & bit(index)) != 0 &&
         below_[static_cast<std::size_t>(face)][static_cast<std::size_t>(index)] != 0;
}

}  // namespace holdfast::agent
