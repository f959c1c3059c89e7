// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "holdfast/base/cell.hpp"
#include "holdfast/module/port.hpp"

/// A port made of six plain serial lines: frames, and who is there.
///
/// On every line that is free a hello byte goes out each 100 ms. A neighbour from whom nothing has
/// been heard for 250 ms counts as gone.
namespace holdfast::module {

inline constexpr Time kHelloEvery = 100'000;
inline constexpr Time kGoneAfter = 250'000;

class SerialPort : public Port {
 public:
  bool receive(Incoming& incoming) final;
  bool is_connected(int face) final;
  void stay_connected() final;
  void send(int face, std::span<const std::uint8_t> packet) final;
  void tell(int face, FrameKind kind, std::span<const std::uint8_t> payload) final;
  void wait(Time until) final;

 protected:
  ~SerialPort() = default;

  /// The next byte that came in on a face; false: there is none.
  virtual bool read(int face, std::uint8_t& byte) = 0;

  /// The memory that bytes to send are to be written to. Only while the line is free.
  virtual std::span<std::uint8_t, kFrameBytesMax> buffer(int face) = 0;

  /// Sends that many bytes from the buffer.
  virtual void transmit(int face, int size) = 0;

  /// Waits as wait() does.
  virtual void sleep(Time until) = 0;

 private:
  struct Face {
    FrameReader reader;
    Time heard_at = 0;
    Time hello_at = 0;
    bool is_connected = false;
  };

  std::array<Face, base::kDirectionCount> faces_;
  int next_ = 0;  ///< The face to look at first, so that all have their turn.
};

}  // namespace holdfast::module
