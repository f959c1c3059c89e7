// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// A robot one of whose lines carries what the input says, with the right checksums or without.
// Nobody may touch memory that is not theirs or say what there is not, and once the line works
// again every module comes to a verdict; sanitizers watch.
#include <cstdint>
#include <cstdlib>
#include <span>

#include "packet_script.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (!holdfast::agent::test::PacketScript({data, size}).run()) {
    std::abort();
  }
  return 0;
}
