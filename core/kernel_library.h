// The kernels of this machine's instruction set, opened on demand.
#pragma once

#include <string>
#include <vector>

namespace halfslope {

/// Instruction sets that kernels are built for. `scalar` is the same templates without packets: the yardstick.
enum class Isa { kScalar, kBaseline, kAvx2, kAvx512 };
std::string to_string(Isa isa);

/// The best set that this processor and its operating system run, or what HALFSLOPE_ISA (scalar, baseline, avx2,
/// avx512) asks for. Throws Error(kUsage) for an unknown name and Error(kBadInput) for a set that the processor lacks.
Isa active_isa();
/// The sets that this processor can run, poorest first.
std::vector<Isa> supported_isas();

/// "fma" for avx2 and avx512, else the set's own name: results are the same bits within a class.
std::string isa_class(Isa isa);

/// The function `symbol` (extern "C", returns a pointer to a room's table of kernels) of the library for `isa`, called.
/// Libraries are found in $HALFSLOPE_KERNELS, in `kernels/` beside the executable, in ../lib*/halfslope, or where the
/// program was installed; Error(kIo) names the places tried.
const void* kernel_table(Isa isa, const char* symbol);

template <class Table>
const Table& kernels(Isa isa = active_isa()) {
  return *static_cast<const Table*>(kernel_table(isa, Table::kSymbol));
}

}  // namespace halfslope
