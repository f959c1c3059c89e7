// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <vector>

#include "block.hpp"
#include "holdfast/sim/event_queue.hpp"
#include "holdfast/sim/link_model.hpp"

/// Does for blocks what VisibleSim does, in its plainest form: with our own simulator's queue and
/// lines behind the same interface.
namespace holdfast::visiblesim {

class PlainWorld {
 public:
  explicit PlainWorld(Ensemble& ensemble) : ensemble_(ensemble) {}

  /// Puts a module into a cell, where it starts now; `random` is that of Block.
  void attach(const base::Cell& cell, std::uint16_t random);

  /// Modules that are there from the beginning start together.
  struct Place {
    base::Cell cell;
    std::uint16_t random = 0;
  };

  void attach_all(const std::vector<Place>& places);

  void detach(const base::Cell& cell);
  void kill(const base::Cell& cell);

  /// Another module comes to the cell, and its neighbours look only then.
  void exchange(const base::Cell& cell, std::uint16_t random);

  /// Runs until nothing happens any more, or until a time at which something will be done.
  void run(Time until = agent::kNever);

  Block& block(const base::Cell& cell) { return *hosts_[host_at_.at(cell)]->block; }

  int packet_bytes_max() const { return packet_bytes_max_; }

  /// The most packets that were on one line at once.
  int line_count_max() const { return line_count_max_; }

 private:
  struct Host final : BlockHost {
    Host(PlainWorld& a_world, std::size_t an_index) : world(a_world), index(an_index) {}

    Time now() override { return world.now_; }

    std::uint64_t neighbour(base::Direction face) override;
    void send(base::Direction face, const Packet& packet) override;
    void call_at(Time at) override;

    void show(const Block&) override {}

    PlainWorld& world;
    std::size_t index;
    std::unique_ptr<Block> block;
    std::array<int, base::kDirectionCount> line_counts{};
  };

  enum class Kind : std::uint8_t { kDeliver, kLine, kCall };

  struct Happening {
    Kind kind{};
    base::Direction face{};
    std::size_t host = 0;
    Time at = 0;  ///< What was asked for.
    std::vector<std::uint8_t> bytes = {};
    std::uint64_t rounds = 0;
  };

  void push(Time at, Happening what);
  void handle(const Happening& what);
  Host& add(const Place& place);
  void look_around(const base::Cell& cell);

  Ensemble& ensemble_;
  std::vector<std::unique_ptr<Host>> hosts_;
  std::map<base::Cell, std::size_t> host_at_;
  std::vector<Happening> happenings_;
  sim::EventQueue queue_;
  Time now_ = 0;
  int packet_bytes_max_ = 0;
  int line_count_max_ = 0;
};

}  // namespace holdfast::visiblesim
