#include "episode.hpp"

#include <utility>

#include "driver.hpp"
#include "random.hpp"

namespace demo {
namespace {

constexpr Point kCornerD{-0.8, -0.8};
constexpr Point kMiddle{0.0, 0.1};

struct Plan {
    std::string_view name;
    int share;  ///< of 100 drives
    Tour tour;
};

/// The goals with a margin, so that a forbidden goal is missed narrowly.
Disc widened(Disc disc, double margin) {
    return {disc.centre, disc.radius + margin};
}

const std::vector<Plan>& plans() {
    const Point a = kGoalA.centre;
    const Point b = kGoalB.centre;
    const Point c = kObstacleC.centre;
    const Disc near_c = widened(kObstacleC, 0.06);
    static const std::vector<Plan> all = {
        {"A then B", 28, {{a, b, kCornerD, kMiddle}, {near_c}, 0.15}},
        {"B then A", 22, {{b, a, kMiddle}, {near_c}, 0.15}},
        {"D, A, then B", 8, {{kCornerD, a, b}, {near_c}, 0.2}},
        {"B and D, not A", 14, {{b, kCornerD, kMiddle}, {near_c, widened(kGoalA, 0.05)}, 0.15}},
        {"A then B, sloppily", 14, {{a, b, kCornerD, kMiddle}, {widened(kObstacleC, 0.02)}, 0.4}},
        {"A, B, cutting C", 8, {{a, b, kMiddle}, {widened(kObstacleC, -0.1)}, 0.2}},
        {"A, through C, B", 6, {{a, c, b}, {}, 0.15}},
    };
    return all;
}

/// Distributes the plans over the drives in a fixed pattern: 37 has no factor in common with 100.
std::size_t plan_of(int drive) {
    int slot = drive * 37 % 100;
    std::size_t plan = 0;
    while (slot >= plans()[plan].share) slot -= plans()[plan++].share;  // the shares sum to 100
    return plan;
}

Car random_state(Random& random) {
    const double x = random.uniform(-kHalfWidth, kHalfWidth);
    const double y = random.uniform(-kHalfWidth, kHalfWidth);
    return {{x, y}, random.uniform(-kPi, kPi)};
}

/// Returns a place away from the goals and from C, with room to turn.
Car random_start(const Route& route, Random& random) {
    for (;;) {
        const Car car = random_state(random);
        const bool away = distance(car.position, kGoalA.centre) > 0.5 &&
                          distance(car.position, kGoalB.centre) > 0.5 &&
                          distance(car.position, kObstacleC.centre) > 0.7;
        if (away && route.can_start(car)) return car;
    }
}

/// Simulates one drive. A slowly wandering disturbance acts on the steering; the result is empty if
/// it pushed the car out of the world.
std::vector<Car> drive(const Route& route, int steps, Random& random) {
    Car car = random_start(route, random);
    Driver driver(route);
    std::vector<Car> states;
    double push = 0;
    for (int step = 0; step < steps; ++step) {
        if (!inside_world(car.position)) return {};
        states.push_back(car);
        push = 0.9 * push + random.uniform(-0.08, 0.08);
        car = car.moved(driver.turn_rate(car) + push, kTimeStep);
    }
    return states;
}

}  // namespace

std::vector<Episode> drive_tours(std::uint64_t seed, int count, int steps) {
    std::vector<Episode> episodes;
    std::vector<Route> routes;
    for (const Plan& plan : plans()) routes.emplace_back(plan.tour);
    Random seeds(seed);
    for (int i = 0; i < count; ++i) {
        const std::size_t plan = plan_of(i);
        Random random(seeds.bits());
        Episode episode{plans()[plan].name, {}};
        while (episode.states.empty()) episode.states = drive(routes[plan], steps, random);
        episodes.push_back(std::move(episode));
    }
    return episodes;
}

std::vector<Car> wander(std::uint64_t seed, int count) {
    constexpr int kStepsEach = 10;
    std::vector<Car> states;
    Random random(seed);
    while (std::cmp_less(states.size(), count)) {
        Car car = random_state(random);
        for (int step = 0; step < kStepsEach && inside_world(car.position); ++step) {
            states.push_back(car);
            for (int i = 0; i < 5; ++i)
                car = car.moved(random.uniform(-kMaxTurnRate, kMaxTurnRate), kTimeStep);
        }
    }
    states.resize(static_cast<std::size_t>(count));
    return states;
}

}  // namespace demo
