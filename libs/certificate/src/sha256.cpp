// SPDX-FileCopyrightText: The holdfast authors
// SPDX-License-Identifier: Apache-2.0
#include "sha256.hpp"

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace holdfast::certificate {
namespace {

using Word = std::uint32_t;

/// The first 32 bits of the fractions of the cube roots of the first 64 primes.
constexpr std::array<Word, 64> kRoots = {
    0x428a2f98U, 0x71374491U, 0xb5c0fbcfU, 0xe9b5dba5U, 0x3956c25bU, 0x59f111f1U, 0x923f82a4U,
    0xab1c5ed5U, 0xd807aa98U, 0x12835b01U, 0x243185beU, 0x550c7dc3U, 0x72be5d74U, 0x80deb1feU,
    0x9bdc06a7U, 0xc19bf174U, 0xe49b69c1U, 0xefbe4786U, 0x0fc19dc6U, 0x240ca1ccU, 0x2de92c6fU,
    0x4a7484aaU, 0x5cb0a9dcU, 0x76f988daU, 0x983e5152U, 0xa831c66dU, 0xb00327c8U, 0xbf597fc7U,
    0xc6e00bf3U, 0xd5a79147U, 0x06ca6351U, 0x14292967U, 0x27b70a85U, 0x2e1b2138U, 0x4d2c6dfcU,
    0x53380d13U, 0x650a7354U, 0x766a0abbU, 0x81c2c92eU, 0x92722c85U, 0xa2bfe8a1U, 0xa81a664bU,
    0xc24b8b70U, 0xc76c51a3U, 0xd192e819U, 0xd6990624U, 0xf40e3585U, 0x106aa070U, 0x19a4c116U,
    0x1e376c08U, 0x2748774cU, 0x34b0bcb5U, 0x391c0cb3U, 0x4ed8aa4aU, 0x5b9cca4fU, 0x682e6ff3U,
    0x748f82eeU, 0x78a5636fU, 0x84c87814U, 0x8cc70208U, 0x90befffaU, 0xa4506cebU, 0xbef9a3f7U,
    0xc67178f2U,
};

constexpr std::size_t kBlockBytes = 64;

/// One block, Sec. 6.2.2; the letters are the standard's.
void digest_block(const unsigned char* block, std::array<Word, 8>& state) {
  std::array<Word, 64> w{};
  for (std::size_t t = 0; t < 16; ++t) {
    w[t] = static_cast<Word>(block[4 * t]) << 24U | static_cast<Word>(block[4 * t + 1]) << 16U |
           static_cast<Word>(block[4 * t + 2]) << 8U | static_cast<Word>(block[4 * t + 3]);
  }
  for (std::size_t t = 16; t < 64; ++t) {
    const Word s0 = std::rotr(w[t - 15], 7) ^ std::rotr(w[t - 15], 18) ^ (w[t - 15] >> 3U);
    const Word s1 = std::rotr(w[t - 2], 17) ^ std::rotr(w[t - 2], 19) ^ (w[t - 2] >> 10U);
    w[t] = s1 + w[t - 7] + s0 + w[t - 16];
  }
  auto [a, b, c, d, e, f, g, h] = state;
  for (std::size_t t = 0; t < 64; ++t) {
    const Word sum1 = std::rotr(e, 6) ^ std::rotr(e, 11) ^ std::rotr(e, 25);
    const Word t1 = h + sum1 + ((e & f) ^ (~e & g)) + kRoots[t] + w[t];
    const Word sum0 = std::rotr(a, 2) ^ std::rotr(a, 13) ^ std::rotr(a, 22);
    const Word t2 = sum0 + ((a & b) ^ (a & c) ^ (b & c));
    h = g;
    g = f;
    f = e;
    e = d + t1;
    d = c;
    c = b;
    b = a;
    a = t1 + t2;
  }
  const std::array<Word, 8> next = {a, b, c, d, e, f, g, h};
  for (std::size_t i = 0; i < next.size(); ++i) {
    state[i] += next[i];
  }
}

/// A one, zeros, and the length in bits, so that whole blocks come out.
std::string padded(std::string_view text) {
  std::string all(text);
  all += '\x80';
  while (all.size() % kBlockBytes != kBlockBytes - 8) {
    all += '\0';
  }
  const std::uint64_t bit_count = std::uint64_t{8} * text.size();
  for (unsigned shift = 64; shift > 0; shift -= 8) {
    all += static_cast<char>((bit_count >> (shift - 8)) & 0xFFU);
  }
  return all;
}

}  // namespace

std::string sha256(std::string_view text) {
  // The first 32 bits of the fractions of the square roots of the first eight primes.
  std::array<Word, 8> state = {0x6a09e667U, 0xbb67ae85U, 0x3c6ef372U, 0xa54ff53aU,
                               0x510e527fU, 0x9b05688cU, 0x1f83d9abU, 0x5be0cd19U};
  const std::string all = padded(text);
  for (std::size_t i = 0; i < all.size(); i += kBlockBytes) {
    digest_block(reinterpret_cast<const unsigned char*>(all.data()) + i, state);
  }
  std::string hexadecimal;
  for (const Word word : state) {
    for (unsigned shift = 32; shift > 0; shift -= 4) {
      hexadecimal += "0123456789abcdef"[(word >> (shift - 4)) & 15U];
    }
  }
  return hexadecimal;
}

}  // namespace holdfast::certificate
