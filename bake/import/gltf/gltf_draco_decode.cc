// No exception leaves this file: whatever the library throws is a block that cannot be read.
#include "import/gltf/gltf_draco_decode.h"
#include <draco/compression/decode.h>
#include <memory>

struct draco_block {
    std::unique_ptr<draco::Mesh> mesh;
};

draco_block *draco_open(const uint8_t *bytes, size_t size) try {
    draco::DecoderBuffer buffer;
    draco::Decoder decoder;
    buffer.Init(reinterpret_cast<const char *>(bytes), size);
    auto mesh = decoder.DecodeMeshFromBuffer(&buffer);
    return mesh.ok() && mesh.value() ? new draco_block{std::move(mesh).value()} : nullptr;
} catch (...) {
    return nullptr;
}

void draco_close(draco_block *block) {
    delete block;
}

uint32_t draco_points(const draco_block *block) {
    return block->mesh->num_points();
}

uint32_t draco_faces(const draco_block *block) {
    return block->mesh->num_faces();
}

void draco_corners(const draco_block *block, uint32_t *out) {
    for (draco::FaceIndex i(0); i < block->mesh->num_faces(); ++i)
        for (int k = 0; k < 3; k++)
            *out++ = block->mesh->face(i)[k].value();
}

unsigned draco_components(const draco_block *block, uint32_t id) {
    const draco::PointAttribute *a = block->mesh->GetAttributeByUniqueId(id);
    return a ? static_cast<unsigned>(a->num_components()) : 0;
}

namespace {

template <typename T> bool values_of(const draco_block *block, const draco::PointAttribute *a, double *out) {
    const int components = a->num_components();
    if (components < 1 || components > 4)
        return false;
    for (draco::PointIndex i(0); i < block->mesh->num_points(); ++i) {
        const draco::AttributeValueIndex at = a->mapped_index(i);
        T value[4];
        if (at.value() >= a->size())
            return false;
        a->GetValue(at, value);
        for (int k = 0; k < components; k++)
            *out++ = static_cast<double>(value[k]);
    }
    return true;
}

} // namespace

bool draco_values(const draco_block *block, uint32_t id, double *out) try {
    const draco::PointAttribute *a = block->mesh->GetAttributeByUniqueId(id);
    switch (a ? a->data_type() : draco::DT_INVALID) {
    case draco::DT_INT8:
        return values_of<int8_t>(block, a, out);
    case draco::DT_UINT8:
        return values_of<uint8_t>(block, a, out);
    case draco::DT_INT16:
        return values_of<int16_t>(block, a, out);
    case draco::DT_UINT16:
        return values_of<uint16_t>(block, a, out);
    case draco::DT_INT32:
        return values_of<int32_t>(block, a, out);
    case draco::DT_UINT32:
        return values_of<uint32_t>(block, a, out);
    case draco::DT_FLOAT32:
        return values_of<float>(block, a, out);
    default:
        return false;
    }
} catch (...) {
    return false;
}
