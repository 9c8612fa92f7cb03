#include "data/parquet/thrift.hpp"

namespace etlc::data::parquet {

/// A bool is a byte in a list, and the type itself in a struct.
void Thrift::pass_over_element(Type type) {
    if (type == Type::yes || type == Type::no)
        bytes_.byte(kWhat);
    else
        pass_over(type);
}

void Thrift::pass_over(Type type) {
    switch (type) {
        case Type::yes:
        case Type::no: return;
        case Type::i8: bytes_.byte(kWhat); return;
        case Type::i16:
        case Type::i32:
        case Type::i64: bytes_.varint(kWhat); return;
        case Type::real: bytes_.take(8, kWhat); return;
        case Type::binary: binary(type); return;
        case Type::list:
        case Type::set: list(type, [&](Type element) { pass_over_element(element); }); return;
        case Type::map: {
            const Nested nested(depth_);
            const std::uint64_t count = bytes_.varint(kWhat);
            if (count == 0) return;
            if (count > bytes_.rest().size()) wrong();
            const std::uint8_t types = bytes_.byte(kWhat);
            for (std::uint64_t i = 0; i < count; ++i) {
                pass_over_element(static_cast<Type>(types >> 4U));
                pass_over_element(static_cast<Type>(types & 0x0fU));
            }
            return;
        }
        case Type::structure: structure([](std::int64_t, Type) { return false; }); return;
        case Type::stop: break;
    }
    wrong();
}

}  // namespace etlc::data::parquet
