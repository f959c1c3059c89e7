// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "holdfast/base/cell.hpp"
#include "holdfast/base/lattice.hpp"

/// Which modules of a robot are neighbours, and which are connected, in few bytes.
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

  std::size_t size() const { return entries_.size() / direction_count_; }

 private:
  std::size_t direction_count_;
  std::vector<std::int32_t> entries_;
};

/// The end `a` of a connection and its direction, in four bytes; the other end is a's neighbour.
class ConnectionCode {
 public:
  ConnectionCode() = default;

  ConnectionCode(std::size_t a, std::size_t direction)
      : bits_(static_cast<std::uint32_t>(a << kDirectionBits | direction)) {}

  std::size_t a() const { return bits_ >> kDirectionBits; }

  std::size_t direction() const { return bits_ & ((1U << kDirectionBits) - 1); }

 private:
  static constexpr unsigned kDirectionBits = 4;
  static_assert(base::Lattice::kDirectionCountMax <= 1 << kDirectionBits);

  std::uint32_t bits_ = 0;
};

/// More modules than this have no codes.
inline constexpr std::size_t kCodedModuleCountMax = std::size_t{1} << 28U;

/// A robot's connections, as a list that makes each of them when it is asked for. Valid as long as
/// the robot.
class Connections {
 public:
  class Iterator {
   public:
    using value_type = Connection;
    using difference_type = std::ptrdiff_t;

    Iterator() = default;

    Iterator(const ConnectionCode* code, const NeighbourTable* connected)
        : code_(code), connected_(connected) {}

    Connection operator*() const {
      return {.a = static_cast<std::int32_t>(code_->a()),
              .b = (*connected_)[code_->a()][code_->direction()],
              .direction = static_cast<base::Direction>(code_->direction())};
    }

    Iterator& operator++() {
      ++code_;
      return *this;
    }

    Iterator operator++(int) {
      const Iterator before = *this;
      ++code_;
      return before;
    }

    friend bool operator==(const Iterator& a, const Iterator& b) { return a.code_ == b.code_; }

   private:
    const ConnectionCode* code_ = nullptr;
    const NeighbourTable* connected_ = nullptr;
  };

  /// Keeps references.
  Connections(std::span<const ConnectionCode> codes, const NeighbourTable& connected)
      : codes_(codes), connected_(&connected) {}

  Connection operator[](std::size_t i) const { return *Iterator(&codes_[i], connected_); }

  Connection front() const { return (*this)[0]; }

  std::size_t size() const { return codes_.size(); }

  bool empty() const { return codes_.empty(); }

  Iterator begin() const { return {codes_.data(), connected_}; }

  Iterator end() const { return {codes_.data() + codes_.size(), connected_}; }

 private:
  std::span<const ConnectionCode> codes_;
  const NeighbourTable* connected_;
};

}  // namespace holdfast::model
