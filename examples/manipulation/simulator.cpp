#include "simulator.hpp"

#include <GL/osmesa.h>
#include <mujoco/mujoco.h>

#include <algorithm>
#include <cstring>
#include <stdexcept>

namespace manipulation {

namespace {

/// MuJoCo reads models from files; this one is in memory.
mjModel* load(const std::string& xml) {
    const auto files = std::make_unique<mjVFS>();
    mj_defaultVFS(files.get());
    mj_makeEmptyFileVFS(files.get(), "scene.xml", static_cast<int>(xml.size()));
    std::memcpy(files->filedata[0], xml.data(), xml.size());
    std::array<char, 500> error{};
    mjModel* model = mj_loadXML("scene.xml", files.get(), error.data(), error.size());
    mj_deleteVFS(files.get());
    if (model == nullptr) throw std::runtime_error(error.data());
    return model;
}

/// Draws in memory, without a display.
class Context {
public:
    Context() : buffer_(4UL * kSide * kSide) {
        context_ = OSMesaCreateContextExt(GL_RGBA, 24, 8, 0, nullptr);
        if (context_ == nullptr ||
            OSMesaMakeCurrent(context_, buffer_.data(), GL_UNSIGNED_BYTE, kSide, kSide) == 0)
            throw std::runtime_error("OSMesa has no context for us");
    }
    ~Context() { OSMesaDestroyContext(context_); }
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

private:
    std::vector<unsigned char> buffer_;
    OSMesaContext context_ = nullptr;
};

}  // namespace

struct Simulator::State {
    explicit State(Task task) : model(load(model_xml(task))) {
        data = mj_makeData(model);
        mjv_defaultScene(&scene);
        mjv_makeScene(model, &scene, 200);
        mjr_defaultContext(&renderer);
        mjr_makeContext(model, &renderer, mjFONTSCALE_100);
        mjr_setBuffer(mjFB_OFFSCREEN, &renderer);
        for (const std::string& name : blocks(task)) {
            block_bodies.push_back(id(mjOBJ_BODY, name));
            block_geoms.push_back(id(mjOBJ_GEOM, name));
        }
        camera = id(mjOBJ_CAMERA, "camera");
        std::copy_n(model->cam_pos + 3 * camera, 3, camera_at.begin());
    }
    ~State() {
        mjr_freeContext(&renderer);
        mjv_freeScene(&scene);
        mj_deleteData(data);
        mj_deleteModel(model);
    }
    State(const State&) = delete;
    State& operator=(const State&) = delete;

    int id(mjtObj kind, const std::string& name) const {
        return mj_name2id(model, kind, name.c_str());
    }

    Context context;  // first, because the renderer needs it
    mjModel* model;
    mjData* data = nullptr;
    mjvScene scene{};
    mjrContext renderer{};
    std::vector<int> block_bodies;
    std::vector<int> block_geoms;
    int camera = 0;
    Position camera_at{};
};

Simulator::Simulator(Task task) : state_(std::make_unique<State>(task)) {}
Simulator::~Simulator() = default;

namespace {

void paint(mjModel& model, int geom, const Color& color) {
    for (std::size_t i = 0; i < 3; ++i)
        model.geom_rgba[4 * geom + i] = static_cast<float>(color[i]);
}

void set(mjData& data, const Setpoint& gripper) {
    for (std::size_t i = 0; i < 3; ++i) data.ctrl[i] = gripper.tip[i];
    data.ctrl[3] = data.ctrl[4] = gripper.closed ? -0.005 : 0.025;
}

}  // namespace

void Simulator::begin(const std::vector<Place>& blocks, const Look& look, const Setpoint& gripper) {
    mjModel& model = *state_->model;
    mjData& data = *state_->data;
    mj_resetData(&model, &data);
    paint(model, state_->id(mjOBJ_GEOM, "table"), look.table);
    for (std::size_t i = 0; i < 3; ++i) {
        model.light_diffuse[i] = static_cast<float>(look.light[i]);
        model.cam_pos[3 * static_cast<std::size_t>(state_->camera) + i] =
            state_->camera_at[i] + look.camera[i];
        data.qpos[i] = gripper.tip[i];
    }
    const int stranger = 3 * state_->id(mjOBJ_GEOM, "stranger");
    model.geom_pos[stranger] = look.stranger[0];
    model.geom_pos[stranger + 1] = look.stranger[1];
    model.geom_pos[stranger + 2] = look.has_stranger ? 0.04 : -1;
    for (std::size_t b = 0; b < blocks.size(); ++b) {
        mjtNum* position =
            data.qpos + model.jnt_qposadr[model.body_jntadr[state_->block_bodies[b]]];
        position[0] = blocks[b][0];
        position[1] = blocks[b][1];
        position[2] = kBlock / 2;
    }
    set(data, gripper);
    mj_forward(&model, &data);
}

void Simulator::step(const Setpoint& gripper) {
    set(*state_->data, gripper);
    const double until = state_->data->time + 1 / kRate - state_->model->opt.timestep / 2;
    while (state_->data->time < until) mj_step(state_->model, state_->data);
}

Position Simulator::tip() const {
    const mjtNum* at = state_->data->qpos;
    return {at[0], at[1], at[2]};
}

Position Simulator::block(std::size_t index) const {
    const mjtNum* at = state_->data->xpos + 3 * state_->block_bodies[index];
    return {at[0], at[1], at[2]};
}

bool Simulator::is_held(std::size_t index) const {
    const int block = state_->block_geoms[index];
    const auto touches = [&](const char* finger) {
        const int other = state_->id(mjOBJ_GEOM, finger);
        return std::any_of(state_->data->contact, state_->data->contact + state_->data->ncon,
                           [&](const mjContact& c) {
                               return (c.geom1 == block && c.geom2 == other) ||
                                      (c.geom1 == other && c.geom2 == block);
                           });
    };
    return touches("left") && touches("right");
}

Image Simulator::image() const {
    State& s = *state_;
    mjvOption option;
    mjv_defaultOption(&option);
    mjvCamera camera;
    mjv_defaultCamera(&camera);
    camera.type = mjCAMERA_FIXED;
    camera.fixedcamid = s.camera;
    mjv_updateScene(s.model, s.data, &option, nullptr, &camera, mjCAT_ALL, &s.scene);
    const mjrRect whole{0, 0, kSide, kSide};
    mjr_render(whole, &s.scene, &s.renderer);
    Image upside_down(3UL * kSide * kSide);
    mjr_readPixels(upside_down.data(), nullptr, whole, &s.renderer);
    Image result(upside_down.size());
    for (std::size_t row = 0; row < kSide; ++row)  // OpenGL starts at the bottom
        std::copy_n(
            upside_down.begin() + static_cast<std::ptrdiff_t>((kSide - 1 - row) * 3 * kSide),
            3 * kSide, result.begin() + static_cast<std::ptrdiff_t>(row * 3 * kSide));
    return result;
}

}  // namespace manipulation
