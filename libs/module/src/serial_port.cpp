// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "holdfast/module/serial_port.hpp"

namespace holdfast::module {

bool SerialPort::receive(Incoming& incoming) {
  for (int i = 0; i < base::kDirectionCount; ++i) {
    const int at = next_;
    next_ = next_ + 1 == base::kDirectionCount ? 0 : next_ + 1;
    Face& face = faces_[static_cast<std::size_t>(at)];
    std::uint8_t byte = 0;
    while (read(at, byte)) {
      const FrameReader::Found found = face.reader.take(byte);
      if (found == FrameReader::Found::kNothing) {
        continue;
      }
      const bool is_frame = found == FrameReader::Found::kFrame;
      if (!is_frame || face.reader.kind() == FrameKind::kPacket) {
        face.heard_at = now();
        face.is_connected = true;
      }
      if (is_frame) {
        incoming = {.face = at, .kind = face.reader.kind(), .payload = face.reader.payload()};
        return true;
      }
    }
  }
  return false;
}

bool SerialPort::is_connected(int face) {
  Face& here = faces_[static_cast<std::size_t>(face)];
  here.is_connected = here.is_connected && now() < here.heard_at + kGoneAfter;
  return here.is_connected;
}

void SerialPort::stay_connected() {
  const Time time = now();
  for (Face& face : faces_) {
    face.heard_at = time;
  }
}

void SerialPort::send(int face, std::span<const std::uint8_t> packet) {
  tell(face, FrameKind::kPacket, packet);
}

void SerialPort::tell(int face, FrameKind kind, std::span<const std::uint8_t> payload) {
  transmit(face, write_frame(kind, payload, buffer(face)));
}

void SerialPort::wait(Time until) {
  const Time time = now();
  for (int at = 0; at < base::kDirectionCount; ++at) {
    Face& face = faces_[static_cast<std::size_t>(at)];
    if (face.hello_at <= time && is_line_free(at)) {
      buffer(at)[0] = kHelloByte;
      transmit(at, 1);
      face.hello_at = time + kHelloEvery;
    }
    until = face.hello_at < until ? face.hello_at : until;
  }
  sleep(until);
}

}  // namespace holdfast::module
