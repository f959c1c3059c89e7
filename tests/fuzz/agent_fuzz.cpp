// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
//
// A robot one of whose modules says what the input tells it to, with the right numbers and
// checksums. Nobody may touch memory that is not theirs, or say what there is not; sanitizers
// watch.
#include <cstdint>
#include <cstdlib>
#include <span>

#include "tampered_network.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr holdfast::agent::Time kTicksMax = 2500;
  if (!holdfast::agent::test::FaultScript({data, size}).run(kTicksMax)) {
    std::abort();
  }
  return 0;
}
