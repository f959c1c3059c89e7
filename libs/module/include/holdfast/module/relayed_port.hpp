// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "holdfast/module/port.hpp"

namespace holdfast::module {

/// A port that hands everything to another one. Who derives from it stands between a board and the
/// program of its module, and takes what is meant for itself.
class RelayedPort : public Port {
 public:
  /// Keeps a reference.
  explicit RelayedPort(Port& port) : port_(port) {}

  Time now() override { return port_.now(); }

  std::uint16_t random() override { return port_.random(); }

  bool receive(Incoming& incoming) override { return port_.receive(incoming); }

  bool is_connected(int face) override { return port_.is_connected(face); }

  void stay_connected() override { port_.stay_connected(); }

  bool is_line_free(int face) override { return port_.is_line_free(face); }

  void send(int face, std::span<const std::uint8_t> packet) override { port_.send(face, packet); }

  void tell(int face, FrameKind kind, std::span<const std::uint8_t> payload) override {
    port_.tell(face, kind, payload);
  }

  void keep(std::span<const std::uint8_t> page) override { port_.keep(page); }

  Health health() override { return port_.health(); }

  void show(const agent::Colour& colour) override { port_.show(colour); }

  void wait(Time until) override { port_.wait(until); }

 protected:
  ~RelayedPort() = default;

  Port& inner() { return port_; }

 private:
  Port& port_;
};

}  // namespace holdfast::module
