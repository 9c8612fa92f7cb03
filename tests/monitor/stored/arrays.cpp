// Writes target sets as .npy: rows in clusters, some of them twice, so that there are ties. Usage:
// arrays FILE ROWS ELEMENTS [SEED]
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>
#include <vector>

int main(int argc, char** argv) {
    if (argc != 4 && argc != 5) return 2;
    const unsigned rows = static_cast<unsigned>(std::atoi(argv[2])),
                   width = static_cast<unsigned>(std::atoi(argv[3]));
    const unsigned seed = argc == 5 ? static_cast<unsigned>(std::atoi(argv[4])) : 0;
    std::mt19937 random(rows * 31 + width + seed * 1000003);
    std::normal_distribution<float> normal;
    std::vector<float> center(width), values;
    for (unsigned k = 0; k < rows; ++k) {
        if (k % 16 == 0) {
            for (float& x : center) x = normal(random);
        }
        const bool again = k % 16 == 9;
        for (unsigned i = 0; i < width; ++i) {
            values.push_back(again ? values[values.size() - 5 * width]
                                   : center[i] + 0.05F * normal(random));
        }
    }
    std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (" +
                         std::to_string(rows) + ", " + std::to_string(width) + "), }";
    header.resize((10 + header.size() + 1 + 63) / 64 * 64 - 11, ' ');
    header += '\n';
    const unsigned char magic[] = {0x93,
                                   'N',
                                   'U',
                                   'M',
                                   'P',
                                   'Y',
                                   1,
                                   0,
                                   static_cast<unsigned char>(header.size() & 0xff),
                                   static_cast<unsigned char>(header.size() >> 8)};
    std::FILE* file = std::fopen(argv[1], "wb");
    if (file == nullptr) return 1;
    std::fwrite(magic, 1, sizeof magic, file);
    std::fwrite(header.data(), 1, header.size(), file);
    std::fwrite(values.data(), sizeof(float), values.size(), file);
    return std::fclose(file) == 0 ? 0 : 1;
}
