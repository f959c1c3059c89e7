// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "holdfast/base/cell.hpp"
#include "holdfast/base/lattice.hpp"
#include "holdfast/host/team.hpp"

/// Stores which modules of a robot are neighbours, and which are connected, in few bytes.
namespace holdfast::model {

/// A connection, that is a beam, between two modules in neighbouring cells; `b` is the neighbour of
/// `a` in a direction with an even index.
struct Connection {
  std::int32_t a = 0;  ///< Index of a module.
  std::int32_t b = 0;
  base::Direction direction = base::Direction::kPlusX;
};

/// Modules by module and direction: for each module as many entries as its lattice has directions.
class NeighbourTable {
 public:
  explicit NeighbourTable(std::size_t direction_count = base::kDirectionCount)
      : direction_count_(direction_count) {}

  /// Makes room for so many modules, without neighbours so far.
  void resize(std::size_t module_count, std::int32_t none) {
    entries_.resize(module_count * direction_count_, none);
  }

  std::span<const std::int32_t> operator[](std::size_t module) const {
    return {entries_.data() + module * direction_count_, direction_count_};
  }

  std::span<std::int32_t> operator[](std::size_t module) {
    return {entries_.data() + module * direction_count_, direction_count_};
  }

  bool empty() const { return entries_.empty(); }

  std::size_t direction_count() const { return direction_count_; }

  std::size_t size() const { return entries_.size() / direction_count_; }

 private:
  std::size_t direction_count_;
  std::vector<std::int32_t> entries_;
};

/// The places of a robot's connections in a table of neighbours: how many come before each fourth
/// module, and before which of these each sixteenth connection is.
class ConnectionIndex {
 public:
  /// Counts the connections of which `a` is one of the first `module_count` modules.
  ConnectionIndex(const NeighbourTable& connected, std::size_t module_count, host::Team& team);

  ConnectionIndex() = default;

  std::size_t size() const { return before_.empty() ? 0 : before_.back(); }

  /// The last fourth module before which there are at most so many.
  std::size_t module_before(std::size_t connection) const;

  std::size_t count_before(std::size_t module) const { return before_[module / kStep]; }

 private:
  static constexpr std::size_t kStep = 4;
  static constexpr std::size_t kConnectionStep = 16;

  void mark_connections();

  std::vector<std::uint32_t> before_;  ///< And how many there are in all.
  std::vector<std::uint32_t> step_of_;
};

/// A robot's connections, as a list that makes each of them when it is asked for: by ascending
/// module, then by ascending direction. To go through them costs less than to ask for one after the
/// other. Valid as long as the robot.
class Connections {
 public:
  class Iterator {
   public:
    using value_type = Connection;
    using difference_type = std::ptrdiff_t;

    Iterator() = default;

    Connection operator*() const {
      return {.a = static_cast<std::int32_t>(a_),
              .b = (*connected_)[a_][direction_],
              .direction = static_cast<base::Direction>(direction_)};
    }

    Iterator& operator++() {
      if (++place_ < end_) {
        step();
      }
      return *this;
    }

    Iterator operator++(int) {
      const Iterator before = *this;
      ++*this;
      return before;
    }

    friend bool operator==(const Iterator& a, const Iterator& b) { return a.place_ == b.place_; }

   private:
    friend Connections;

    /// Goes to the next connection, which there must be.
    void step() {
      do {
        direction_ += 2;
        if (direction_ >= connected_->direction_count()) {
          direction_ = 0;
          ++a_;
        }
      } while ((*connected_)[a_][direction_] < 0);
    }

    const NeighbourTable* connected_ = nullptr;
    std::size_t a_ = 0;
    std::size_t direction_ = 0;
    std::size_t place_ = 0;
    std::size_t end_ = 0;
  };

  /// Keeps references.
  Connections(const ConnectionIndex& index, const NeighbourTable& connected)
      : index_(&index), connected_(&connected) {}

  Connection operator[](std::size_t i) const { return *from(i); }

  Connection front() const { return *begin(); }

  std::size_t size() const { return index_->size(); }

  bool empty() const { return size() == 0; }

  Iterator begin() const { return from(0); }

  Iterator end() const { return from(size()); }

  /// An iterator that goes on from the connection number i.
  Iterator from(std::size_t i) const;

 private:
  const ConnectionIndex* index_;
  const NeighbourTable* connected_;
};

}  // namespace holdfast::model
