// Reads .npy: any bytes give an array that matches its shape, or an error.
#include "data/arrays/array.hpp"
#include "fuzz_target.hpp"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    namespace fuzz = etlc::fuzz;
    const fuzz::File file(fuzz::text(data, size));
    const auto array = etlc::data::read_npy(file.path());
    if (!array) {
        fuzz::require_printable(array.failure().message);
        return 0;
    }
    std::uint64_t count = 1;
    for (const std::uint64_t n : array->shape) count *= n;
    fuzz::require(array->values.size() == count,
                  "the number of values is the product of the shape");
    fuzz::require(count <= size, "there is no value without a byte");
    return 0;
}
