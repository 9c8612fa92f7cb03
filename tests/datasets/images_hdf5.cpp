// images_hdf5 FILE: writes two demonstrations as robomimic does, images compressed with GZIP, with
// numbers that image_arrays_test.py computes too.
#include <hdf5.h>

#include <string>
#include <vector>

namespace {

constexpr hsize_t kSteps = 4, kRows = 6, kColumns = 8;

template <class T>
void write(hid_t file, const std::string& name, hid_t type, const std::vector<hsize_t>& shape,
           const std::vector<T>& values) {
    const hid_t links = H5Pcreate(H5P_LINK_CREATE);
    H5Pset_create_intermediate_group(links, 1);
    const hid_t packed = H5Pcreate(H5P_DATASET_CREATE);
    std::vector<hsize_t> chunk = shape;
    chunk[0] = 1;
    H5Pset_chunk(packed, static_cast<int>(chunk.size()), chunk.data());
    H5Pset_deflate(packed, 4);
    const hid_t space = H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr);
    const hid_t set = H5Dcreate2(file, name.c_str(), type, space, links, packed, H5P_DEFAULT);
    H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
    H5Dclose(set);
}

std::vector<unsigned char> images(hsize_t first) {
    std::vector<unsigned char> pixels;
    for (hsize_t step = 0; step < kSteps; ++step)
        for (hsize_t row = 0; row < kRows; ++row)
            for (hsize_t column = 0; column < kColumns; ++column)
                for (hsize_t channel = 0; channel < 3; ++channel)
                    pixels.push_back(static_cast<unsigned char>(first + 11 * step + 5 * row +
                                                                3 * column + channel));
    return pixels;
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    const hid_t file = H5Fcreate(argv[1], H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    for (unsigned demo = 0; demo < 2; ++demo) {
        const std::string group = "data/demo_" + std::to_string(demo) + "/";
        const std::vector<hsize_t> shape = {kSteps, kRows, kColumns, 3};
        write(file, group + "obs/agentview_image", H5T_NATIVE_UCHAR, shape, images(37 * demo));
        write(file, group + "obs/eye_in_hand_image", H5T_NATIVE_UCHAR, shape, images(7));
        write(file, group + "obs/grey_image", H5T_NATIVE_UCHAR, {kSteps, kRows, 3 * kColumns},
              images(7));
        std::vector<double> q, grip;
        for (unsigned step = 0; step < kSteps; ++step) {
            for (unsigned i = 0; i < 3; ++i) q.push_back(demo + step + i / 2.0);
            grip.push_back(step / 4.0 + demo);
        }
        write(file, group + "obs/eef_pos", H5T_NATIVE_DOUBLE, {kSteps, 3}, q);
        write(file, group + "actions", H5T_NATIVE_DOUBLE, {kSteps, 1}, grip);
    }
    return H5Fclose(file) < 0 ? 1 : 0;
}
