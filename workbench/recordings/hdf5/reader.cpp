// etlc-read-hdf5: the only program that links libhdf5, which hostile files can crash.
// It speaks the protocol of recordings/records/protocol.hpp.
// Keeps true: its own memory, files and time are limited before a file is opened; no plugin is
// loaded; no link leads to another file.
#include <fnmatch.h>
#include <hdf5.h>

#include <algorithm>
#include <charconv>
#include <cstdlib>
#include <cstring>
#include <new>
#include <string>
#include <utility>
#include <vector>

#include "recordings/records/protocol.hpp"

namespace {

using namespace etlc::recordings::records;

constexpr std::size_t kChunkCacheBytes = 64U << 20U;  ///< of each dataset
constexpr std::size_t kMaxListed = 8;                 ///< names in a message

// ---- files and links ----------------------------------------------------------------------------

hid_t open_file(const char* path) {
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
    H5PLset_loading_state(0);
    // A chunk larger than the cache would be unpacked again for every block of rows.
    const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
    H5Pset_cache(access, 0, 521, kChunkCacheBytes, 1.0);
    const hid_t file = H5Fopen(path, H5F_ACC_RDONLY, access);
    if (file < 0) fail(Cause::file, "is no HDF5 file, or a damaged one");
    return file;
}

std::vector<std::string> parts_of(const std::string& path) {
    std::vector<std::string> parts;
    std::string part;
    for (const char c : path + '/') {
        if (c != '/') {
            part += c;
        } else if (!part.empty()) {
            parts.push_back(std::move(part));
            part.clear();
        }
    }
    return parts;
}

/// Opens an object in a group; negative where it is missing. Links to other files are not followed.
hid_t open_member(hid_t group, const std::string& name) {
    H5L_info_t info{};
    if (H5Lexists(group, name.c_str(), H5P_DEFAULT) <= 0) return -1;
    if (H5Lget_info(group, name.c_str(), &info, H5P_DEFAULT) < 0) return -1;
    // A soft link may lead to an external one.
    if (info.type != H5L_TYPE_HARD)
        fail(Cause::channel, "'" + name + "' is a soft or external link, which is not followed");
    return H5Oopen(group, name.c_str(), H5P_DEFAULT);
}

/// Opens the group `path`, relative to `from`.
hid_t open_object(hid_t from, const std::string& path) {
    hid_t object = from;
    for (const std::string& part : parts_of(path)) {
        if (H5Iget_type(object) != H5I_GROUP && H5Iget_type(object) != H5I_FILE) return -1;
        object = open_member(object, part);
        if (object < 0) return -1;
    }
    return object;
}

herr_t collect(hid_t, const char* name, const H5L_info_t*, void* names) {
    auto& list = *static_cast<std::vector<std::string>*>(names);
    list.emplace_back(name);
    return list.size() < kMaxNames ? 0 : -1;
}

std::vector<std::string> members(hid_t group) {
    std::vector<std::string> names;
    if (H5Literate(group, H5_INDEX_NAME, H5_ITER_INC, nullptr, collect, &names) < 0)
        fail(Cause::file, "has a group that cannot be listed");
    std::sort(names.begin(), names.end());
    return names;
}

/// Lists the existing names where one was not found: "'a', 'b'".
std::string listed(hid_t group) {
    if (H5Iget_type(group) != H5I_GROUP && H5Iget_type(group) != H5I_FILE) return "";
    const std::vector<std::string> names = members(group);
    std::string text;
    for (std::size_t i = 0; i < std::min(names.size(), kMaxListed); ++i)
        text += (i > 0 ? ", '" : "'") + names[i] + "'";
    if (names.size() > kMaxListed)
        text += " and " + std::to_string(names.size() - kMaxListed) + " more";
    return text.empty() ? "" : "; there are " + text;
}

/// Sends the groups below `group` that match the rest of the pattern.
void list(hid_t group, const std::string& prefix, const std::vector<std::string>& pattern,
          std::size_t at) {
    if (at == pattern.size()) return send(Tag::name, prefix);
    for (const std::string& name : members(group)) {
        if (::fnmatch(pattern[at].c_str(), name.c_str(), 0) != 0) continue;
        const hid_t member = open_member(group, name);
        if (member < 0) fail(Cause::file, "has a group that cannot be opened");
        if (H5Iget_type(member) == H5I_GROUP)
            list(member, prefix.empty() ? name : prefix + "/" + name, pattern, at + 1);
        H5Oclose(member);
    }
}

// ---- datasets -----------------------------------------------------------------------------------

struct Channel {
    std::string name;
    std::size_t width = 1;
    bool optional = false;
    bool times = false;
    hid_t dataset = -1;
    hid_t memory_type = -1;
    bool bools = false;
    std::vector<hsize_t> shape;
    std::vector<double> constant;  ///< of an attribute

    bool present() const { return dataset >= 0 || !constant.empty(); }
    std::string quoted() const { return "'" + name + "'"; }
};

/// Numbers are read as doubles; h5py stores bools as an enumeration of one byte.
void find_type(Channel& channel) {
    const hid_t type = H5Dget_type(channel.dataset);
    const H5T_class_t kind = H5Tget_class(type);
    channel.bools = kind == H5T_ENUM && H5Tget_size(type) == 1 && H5Tget_nmembers(type) == 2;
    const bool number = (kind == H5T_INTEGER || kind == H5T_FLOAT) && H5Tget_size(type) <= 8;
    if (!number && !channel.bools)
        fail(Cause::elements,
             "dataset " + channel.quoted() + " has elements that are neither numbers nor bools");
    channel.memory_type =
        channel.bools ? H5Tget_native_type(type, H5T_DIR_ASCEND) : H5T_NATIVE_DOUBLE;
}

void find_shape(Channel& channel) {
    const hid_t space = H5Dget_space(channel.dataset);
    const int rank = H5Sget_simple_extent_ndims(space);
    if (rank < 0 || rank > H5S_MAX_RANK)
        fail(Cause::array, "dataset " + channel.quoted() + " has a damaged shape");
    channel.shape.resize(static_cast<std::size_t>(rank));
    if (rank > 0) H5Sget_simple_extent_dims(space, channel.shape.data(), nullptr);
}

/// Returns whether a dataset lies in another file, or is composed of other files.
void refuse_foreign_data(const Channel& channel) {
    const hid_t properties = H5Dget_create_plist(channel.dataset);
    if (H5Pget_external_count(properties) != 0 || H5Pget_layout(properties) == H5D_VIRTUAL)
        fail(Cause::array,
             "dataset " + channel.quoted() + " keeps its data in other files, which are not read");
}

/// Reads '@NAME', a number or bool that is an attribute of the group, as an array of one element.
void read_attribute(hid_t group, Channel& channel) {
    const char* const name = channel.name.c_str() + 1;
    if (H5Aexists(group, name) <= 0) return;
    const hid_t attribute = H5Aopen(group, name, H5P_DEFAULT);
    const hid_t type = H5Aget_type(attribute);
    const H5T_class_t kind = H5Tget_class(type);
    const bool is_bool = kind == H5T_ENUM && H5Tget_size(type) == 1;
    const bool is_number = (kind == H5T_INTEGER || kind == H5T_FLOAT) && H5Tget_size(type) <= 8;
    if (H5Sget_simple_extent_npoints(H5Aget_space(attribute)) != 1 || (!is_bool && !is_number))
        fail(Cause::elements,
             "attribute '" + channel.name.substr(1) + "' is neither a number nor a bool");
    signed char byte = 0;
    double number = 0;
    const herr_t read = is_bool
                            ? H5Aread(attribute, H5Tget_native_type(type, H5T_DIR_ASCEND), &byte)
                            : H5Aread(attribute, H5T_NATIVE_DOUBLE, &number);
    if (read < 0) fail(Cause::array, "attribute '" + channel.name.substr(1) + "' is damaged");
    channel.constant = {is_bool ? byte : number};
    channel.shape = {1};
}

void open_channel(hid_t group, Channel& channel) {
    channel.dataset = open_object(group, channel.name);
    if (!channel.present() && channel.name.starts_with("@")) read_attribute(group, channel);
    if (!channel.constant.empty()) return;
    if (!channel.present()) {
        if (channel.optional) return;
        const std::string whole = channel.name.substr(0, channel.name.rfind('['));
        if (channel.name.ends_with("]") && !whole.empty() && open_object(group, whole) >= 0)
            fail(Cause::channel, "no dataset " + channel.quoted() + ", but '" + whole +
                                     "', of which no single elements are taken: save the element "
                                     "as a separate dataset");
        fail(Cause::channel, "no dataset " + channel.quoted() + listed(group));
    }
    if (H5Iget_type(channel.dataset) != H5I_DATASET)
        fail(Cause::channel, channel.quoted() + " is no dataset");
    refuse_foreign_data(channel);
    find_type(channel);
    find_shape(channel);
}

bool fits(const Channel& channel) {
    if (channel.shape.size() == 1) return channel.width == 1;
    return channel.shape.size() == 2 && channel.shape[1] == channel.width;
}

/// Opens the times of steps; they stay absent where they are not a number for each of the steps.
void open_times(hid_t group, Channel& channel, const std::vector<Channel>& others) {
    H5L_info_t info{};
    if (H5Lexists(group, channel.name.c_str(), H5P_DEFAULT) <= 0 ||
        H5Lget_info(group, channel.name.c_str(), &info, H5P_DEFAULT) < 0 ||
        info.type != H5L_TYPE_HARD)
        return;
    const hid_t dataset = open_object(group, channel.name);
    if (dataset < 0 || H5Iget_type(dataset) != H5I_DATASET) return;
    const hid_t type = H5Dget_type(dataset);
    const H5T_class_t kind = H5Tget_class(type);
    if ((kind != H5T_INTEGER && kind != H5T_FLOAT) || H5Tget_size(type) > 8) return;
    open_channel(group, channel);
    const auto some = std::find_if(others.begin(), others.end(),
                                   [](const Channel& other) { return other.present(); });
    if (some == others.end() || some->shape.empty() || !fits(channel) ||
        channel.shape[0] != some->shape[0])
        channel.dataset = -1;
}

std::string shape_line(const Channel& channel) {
    if (!channel.present()) return "absent\n";
    std::string line = channel.bools ? "bool" : "number";
    for (const hsize_t n : channel.shape) line += " " + std::to_string(n);
    return line + "\n";
}

/// Names the first filter of a dataset that libhdf5 does not have.
std::string why_unread(const Channel& channel) {
    const hid_t properties = H5Dget_create_plist(channel.dataset);
    const int filters = H5Pget_nfilters(properties);
    for (int i = 0; i < filters; ++i) {
        unsigned flags = 0;
        std::size_t values = 0;
        char name[64] = "";
        const H5Z_filter_t filter =
            H5Pget_filter2(properties, static_cast<unsigned>(i), &flags, &values, nullptr,
                           sizeof name - 1, name, nullptr);
        if (filter < 0 || H5Zfilter_avail(filter) > 0) continue;
        return " is packed by the filter '" + std::string(name) + "' (number " +
               std::to_string(filter) +
               "), which is not read; pack it again with compression='gzip' in h5py, or by "
               "'h5repack -f GZIP=4 OLD.h5 NEW.h5'";
    }
    return " cannot be read: it is damaged";
}

/// Reads `count` steps from `first` on into rows of `stride` doubles.
void read_block(const Channel& channel, hsize_t first, hsize_t count, double* to,
                std::size_t stride) {
    if (!channel.constant.empty()) {
        *to = channel.constant[0];
        return;
    }
    const std::size_t n = count * channel.width;
    const hid_t file_space = H5Dget_space(channel.dataset);
    const hsize_t start[2] = {first, 0};
    const hsize_t size[2] = {count, channel.width};
    const hsize_t total = n;
    const hid_t memory_space = H5Screate_simple(1, &total, nullptr);
    std::vector<double> values(n);
    std::vector<signed char> bools(channel.bools ? n : 0);
    void* const buffer = channel.bools ? static_cast<void*>(bools.data()) : values.data();
    if (H5Sselect_hyperslab(file_space, H5S_SELECT_SET, start, nullptr, size, nullptr) < 0 ||
        H5Dread(channel.dataset, channel.memory_type, memory_space, file_space, H5P_DEFAULT,
                buffer) < 0)
        fail(Cause::array, "dataset " + channel.quoted() + why_unread(channel));
    H5Sclose(memory_space);
    H5Sclose(file_space);
    std::copy(bools.begin(), bools.end(), values.begin());
    for (hsize_t row = 0; row < count; ++row)
        std::copy_n(values.begin() + static_cast<std::ptrdiff_t>(row * channel.width),
                    channel.width, to + row * stride);
}

void send_rows(const std::vector<Channel>& channels, hsize_t steps, std::size_t width) {
    const std::size_t row_bytes = width * sizeof(double);
    const hsize_t block = std::clamp<hsize_t>(kBlockBytes / row_bytes, 1, steps);
    std::vector<double> rows(block * width);
    for (hsize_t first = 0; first < steps; first += block) {
        const hsize_t count = std::min(block, steps - first);
        std::size_t offset = 0;
        for (const Channel& channel : channels) {
            if (!channel.present()) continue;
            read_block(channel, first, count, rows.data() + offset, width);
            offset += channel.width;
        }
        send(Tag::rows, reinterpret_cast<const char*>(rows.data()), count * row_bytes);
    }
}

void read(hid_t file, const std::string& path, std::vector<Channel>& channels) {
    const hid_t group = open_object(file, path);
    if (group < 0) fail(Cause::channel, "no group '" + path + "'" + listed(file));
    for (Channel& channel : channels)
        if (channel.times)
            open_times(group, channel, channels);
        else
            open_channel(group, channel);
    std::string shapes;
    for (const Channel& channel : channels) shapes += shape_line(channel);
    send(Tag::shapes, shapes);

    const Channel* some = nullptr;
    std::size_t width = 0;
    for (const Channel& channel : channels) {
        if (!channel.present()) continue;
        if (!fits(channel) || (some != nullptr && some->shape[0] != channel.shape[0]))
            quit(0);  // etlc says why
        some = &channel;
        width += channel.width;
    }
    if (some == nullptr) quit(0);
    send_rows(channels, some->shape[0], width);
}

// ---- images -------------------------------------------------------------------------------------

bool holds_bytes(hid_t dataset) {
    const hid_t type = H5Dget_type(dataset);
    return H5Tget_class(type) == H5T_INTEGER && H5Tget_size(type) == 1 &&
           H5Tget_sign(type) == H5T_SGN_NONE;
}

bool holds_images(hid_t dataset) {
    const hid_t space = H5Dget_space(dataset);
    hsize_t shape[H5S_MAX_RANK] = {};
    return holds_bytes(dataset) && H5Sget_simple_extent_ndims(space) == 4 &&
           H5Sget_simple_extent_dims(space, shape, nullptr) == 4 && shape[3] == 3;
}

bool holds_grey_images(hid_t dataset) {
    return holds_bytes(dataset) && H5Sget_simple_extent_ndims(H5Dget_space(dataset)) == 3;
}

/// Finds the datasets of images in a group and below it.
void find_images(hid_t group, const std::string& prefix, int depth,
                 std::vector<std::string>& found) {
    constexpr int kMostNested = 8;
    if (depth > kMostNested || found.size() > kMaxListed) return;
    for (const std::string& name : members(group)) {
        H5L_info_t info{};
        if (H5Lget_info(group, name.c_str(), &info, H5P_DEFAULT) < 0 || info.type != H5L_TYPE_HARD)
            continue;
        const hid_t member = H5Oopen(group, name.c_str(), H5P_DEFAULT);
        if (member < 0) continue;
        if (H5Iget_type(member) == H5I_GROUP)
            find_images(member, prefix + name + "/", depth + 1, found);
        if (H5Iget_type(member) == H5I_DATASET && holds_images(member))
            found.push_back(prefix + name);
        H5Oclose(member);
    }
}

std::string only_images(hid_t group) {
    std::vector<std::string> found;
    find_images(group, "", 0, found);
    if (found.empty())
        fail(Cause::channel,
             "has no dataset of images, (steps, rows, columns, 3) of uint8" + listed(group));
    if (found.size() == 1) return found[0];
    std::string names;
    for (std::size_t i = 0; i < std::min(found.size(), kMaxListed); ++i)
        names += (i > 0 ? ", '" : "'") + found[i] + "'";
    fail(Cause::channel,
         "has the datasets of images " + names + "; name one: --camera " + found[0]);
}

void send_images(hid_t file, const std::string& path, const std::string& name, bool with_grey) {
    const hid_t group = open_object(file, path);
    if (group < 0) fail(Cause::channel, "no group '" + path + "'" + listed(file));
    Channel channel;
    channel.name = name.empty() ? only_images(group) : name;
    open_channel(group, channel);
    const bool is_grey = with_grey && holds_grey_images(channel.dataset);
    if (!is_grey && !holds_images(channel.dataset))
        fail(Cause::elements, "dataset " + channel.quoted() +
                                  " holds no images, expected (steps, rows, columns, 3)" +
                                  (with_grey ? ", or (steps, rows, columns) of grey, " : " ") +
                                  "of uint8");
    send(Tag::shapes, shape_line(channel));
    constexpr hsize_t kMostBytes = 256U << 20U;
    const auto& shape = channel.shape;
    if (shape[1] > kMostBytes || shape[2] > kMostBytes || shape[1] * shape[2] > kMostBytes / 3)
        quit(0);  // etlc says why
    const hsize_t size = shape[1] * shape[2] * (is_grey ? 1 : 3);
    std::vector<char> image(size);
    const hid_t memory_space = H5Screate_simple(1, &size, nullptr);
    for (hsize_t step = 0; step < shape[0]; ++step) {
        const hid_t file_space = H5Dget_space(channel.dataset);
        const hsize_t start[4] = {step, 0, 0, 0};
        const hsize_t count[4] = {1, shape[1], shape[2], 3};
        if (H5Sselect_hyperslab(file_space, H5S_SELECT_SET, start, nullptr, count, nullptr) < 0 ||
            H5Dread(channel.dataset, H5T_NATIVE_UINT8, memory_space, file_space, H5P_DEFAULT,
                    image.data()) < 0)
            fail(Cause::array, "dataset " + channel.quoted() + why_unread(channel));
        H5Sclose(file_space);
        for (hsize_t at = 0; at < size; at += kMaxRecordBytes)
            send(Tag::rows, image.data() + at, std::min<hsize_t>(kMaxRecordBytes, size - at));
    }
}

std::vector<Channel> parse_channels(char** words, int count) {
    std::vector<Channel> channels;
    for (int i = 0; i + 3 <= count; i += 3) {
        Channel channel;
        std::from_chars(words[i], words[i] + std::strlen(words[i]), channel.width);
        channel.name = words[i + 1];
        channel.optional = words[i + 2] == kOptional;
        channel.times = words[i + 2] == kTimes;
        channels.push_back(std::move(channel));
    }
    return channels;
}

}  // namespace

int main(int argc, char** argv) {
    const std::string command = argc >= 4 ? argv[1] : "";
    const bool is_images = command == "images" || command == "grey_images";
    const bool is_known = command == "list" || command == "read" || (is_images && argc == 5);
    if (!is_known) return 2;
    limit_resources();
    ::setenv("HDF5_USE_FILE_LOCKING", "FALSE",
             1);  // file systems that are read-only, or that cannot lock
    try {
        const hid_t file = open_file(argv[2]);
        if (command == "list") {
            list(file, "", parts_of(argv[3]), 0);
        } else if (is_images) {
            send_images(file, argv[3], argv[4], command == "grey_images");
        } else {
            std::vector<Channel> channels = parse_channels(argv + 4, argc - 4);
            read(file, argv[3], channels);
        }
    } catch (const std::bad_alloc&) {
        fail(Cause::file, "takes more memory than reading it may");
    }
    done();
}
