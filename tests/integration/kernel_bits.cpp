// Prints what factors of a fixed random matrix make of a fixed vector, bit by bit: built for several instruction sets, and compared.
#include <bit>
#include <cstdint>
#include <cstdio>
#include <random>
#include <vector>

#include "linalg/block_solver.h"

namespace keyblock::linalg {
namespace {

void print(const char* what, const std::vector<double>& x) {
  std::uint64_t hash = 14'695'981'039'346'656'037U;  // FNV-1a
  for (const double v : x) hash = (hash ^ std::bit_cast<std::uint64_t>(v)) * 1'099'511'628'211U;
  std::printf("%s %016llx\n", what, static_cast<unsigned long long>(hash));
}

double uniform(std::mt19937& random) {
  return static_cast<double>(random()) / 2'147'483'648.0 - 1.0;
}

void solve(const char* what, BlockSolver& solver, const std::vector<int>& choice) {
  constexpr int blocks = 60;
  std::mt19937 random(11);
  std::vector<int> sizes;
  std::vector<std::pair<int, int>> pairs;
  std::size_t unknowns = 0;
  for (int b = 0; b < blocks; ++b) {
    sizes.push_back(choice[random() % choice.size()]);
    unknowns += static_cast<std::size_t>(sizes.back());
    if (b >= 1) pairs.emplace_back(b - 1, b);
    if (b >= 7) pairs.emplace_back(b, b - 7);
  }
  solver.analyse(sizes, pairs);
  solver.clear();
  for (int b = 0; b < blocks; ++b) {
    const int size = sizes[static_cast<std::size_t>(b)];
    for (int k = 0; k < size; ++k) solver.diagonal(b)[k * padded_rows(size) + k] = 80.0 + uniform(random);
  }
  for (int k = 0; k < static_cast<int>(pairs.size()); ++k) {
    const BlockSlot slot = solver.slot(k);
    for (int c = 0; c < sizes[static_cast<std::size_t>(slot.column)]; ++c) {
      for (int r = 0; r < sizes[static_cast<std::size_t>(slot.row)]; ++r)
        slot.values[c * slot.stride + r] = uniform(random);
    }
  }
  std::vector<double> x(unknowns), residual(unknowns);
  for (double& v : x) v = uniform(random);
  if (!solver.factor()) std::printf("not positive definite\n");
  // A first solution is good enough, so that what it has not is seen as well.
  solver.solve(x, residual, [](std::span<const double>) { return 1.0; });
  print(what, x);
  print(what, residual);
}

}  // namespace
}  // namespace keyblock::linalg

int main() {
  using namespace keyblock::linalg;
  for (const std::vector<int>& choice : {std::vector{6}, {12}, {6, 12, 20}}) {
    solve("full", *make_block_cholesky(Precision::full), choice);
    solve("single", *make_block_cholesky(Precision::single), choice);
    solve("iterative", *make_block_conjugate_residual(nullptr), choice);
  }
}
