#pragma once
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace keyblock::report {

/// Numbers are held at this many quanta.
inline constexpr double most_quanta = 1 << 30;

/// A table of numbers x[f][i] (row f: a frame) as multiples of a quantum q, packed for deflate:
///
///   n[f][i] = round(x[f][i] / q)
///   d[f][i] = n[f][i] − n[f−1][i]            (n[−1] = 0)
///   e[f][i] = d[f][i] − d[f][i−1]            (d[f][−1] = 0)
///   z       = e < 0 ? −2e − 1 : 2e           modulo 2^32
///
/// then the four bytes of all z apart: first all lowest bytes, last all highest. Neighbours in a row
/// (vertices of one block) mostly move together and most blocks rest between frames, so that nearly all bytes
/// are zero. The error is at most q/2. Numbers beyond ±2^30 q and such that are not finite are held at that
/// bound or become 0.
std::vector<std::uint8_t> encode_frames(std::size_t frames, std::size_t columns, double quantum,
                                        const std::function<double(std::size_t, std::size_t)>& value);

/// Inverse of encode_frames, row after row.
std::vector<double> decode_frames(std::span<const std::uint8_t> bytes, std::size_t frames,
                                  std::size_t columns, double quantum);

}  // namespace keyblock::report
