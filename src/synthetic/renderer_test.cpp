// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "synthetic/renderer.h"

#include <gtest/gtest.h>

#include "core/error.h"
#include "synthetic/camera_path.h"
#include "synthetic/test_worlds.h"
#include "synthetic/world_builder.h"

namespace dxslam {
namespace {

using testing_worlds::facing_rectangle;
using testing_worlds::small_camera;

World world_of(std::vector<Surface> surfaces) {
  World world;
  world.textures.emplace_back(cv::Mat(16, 16, CV_8UC3, cv::Scalar::all(255)));
  world.textures.emplace_back(cv::Mat(16, 16, CV_8UC3, cv::Scalar::all(0)));
  world.surfaces = std::move(surfaces);
  return world;
}

bool same(const cv::Mat& a, const cv::Mat& b) { return cv::norm(a, b, cv::NORM_INF) == 0.0; }

TEST(Renderer, DrawsARectangleWhereItsCornersProject) {
  const Camera camera = small_camera();
  const World world = world_of({facing_rectangle(-0.5, -0.3, 0.8, 0.5, 2.0)});
  const Rendering r = render(world, {}, camera, SE3(), {});
  const Eigen::Vector2d low = camera.project({-0.5, -0.3, 2.0}),
                        high = camera.project({0.3, 0.2, 2.0});
  for (int y = 0; y < camera.height; ++y) {
    for (int x = 0; x < camera.width; ++x) {
      const bool inside = x >= low.x() && y >= low.y() && x < high.x() && y < high.y();
      ASSERT_EQ(r.surface.at<int>(y, x), inside ? 0 : -1) << x << " " << y;
      ASSERT_NEAR(r.depth.at<float>(y, x), inside ? 2.0 : 0.0, 1e-5);
    }
  }
}

TEST(Renderer, NearerSurfaceHidesTheFarther) {
  std::vector<Surface> surfaces = {facing_rectangle(-1, -1, 2, 2, 3.0),
                                   facing_rectangle(-0.2, -0.2, 0.4, 0.4, 1.0),
                                   facing_rectangle(-1, -1, 2, 2, 4.0)};
  const Rendering r = render(world_of(surfaces), {}, small_camera(), SE3(), {});
  EXPECT_NEAR(r.depth.at<float>(60, 80), 1.0, 1e-5);
  EXPECT_EQ(r.surface.at<int>(60, 80), 1);
  EXPECT_NEAR(r.depth.at<float>(60, 40), 3.0, 1e-5);
}

TEST(Renderer, BackOfASurfaceIsInvisible) {
  Surface s = facing_rectangle(-1, -1, 2, 2, 3.0);
  s.corner.x() = 1;
  s.edge_u.x() = -2;
  const Rendering r = render(world_of({s}), {}, small_camera(), SE3(), {});
  EXPECT_EQ(r.surface.at<int>(60, 80), -1);
  EXPECT_EQ(r.depth.at<float>(60, 80), 0.0F);
}

TEST(Renderer, ExtraSurfacesCountAfterThoseOfTheWorld) {
  const World world = world_of({facing_rectangle(-1, -1, 2, 2, 3.0)});
  const Rendering r =
      render(world, {facing_rectangle(-0.1, -0.1, 0.2, 0.2, 1.0)}, small_camera(), SE3(), {});
  EXPECT_EQ(r.surface.at<int>(60, 80), 1);
}

TEST(Renderer, BorderPixelsAreMixed) {
  Surface black = facing_rectangle(0.0, -1, 1, 2, 1.0);  // begins half a pixel right of column 79
  black.texture = 1;
  const World world = world_of({facing_rectangle(-2, -2, 4, 4, 2.0), black});
  Camera camera = small_camera();
  camera.cx = 79.0;
  const Rendering smooth = render(world, {}, camera, SE3(), {});
  EXPECT_NEAR(smooth.radiance.at<cv::Vec3f>(60, 79)[0], 0.5, 0.01);
  EXPECT_NEAR(smooth.radiance.at<cv::Vec3f>(60, 77)[0], 1.0, 0.01);
  EXPECT_NEAR(smooth.radiance.at<cv::Vec3f>(60, 81)[0], 0.0, 0.01);
  RenderOptions rough;
  rough.antialias = false;
  const float value = render(world, {}, camera, SE3(), rough).radiance.at<cv::Vec3f>(60, 79)[0];
  EXPECT_TRUE(value < 0.01F || value > 0.99F) << value;
}

TEST(Renderer, LightIsInterpolatedAcrossTheSurface) {
  Surface s = facing_rectangle(-1, -1, 2, 2, 2.0);
  s.light.nodes[1] = s.light.nodes[3] = Eigen::Vector3f::Zero();
  const Rendering r = render(world_of({s}), {}, small_camera(), SE3(), {});
  const Eigen::Vector2d quarter = small_camera().project({-0.5, 0.0, 2.0});
  EXPECT_NEAR(r.radiance.at<cv::Vec3f>(60, static_cast<int>(quarter.x() + 0.5))[1], 0.75, 0.01);
}

TEST(Renderer, RefusesADistortedCamera) {
  Camera camera = small_camera();
  camera.lens.parameters[0] = 0.1;
  EXPECT_THROW(render(world_of({}), {}, camera, SE3(), {}), ContractError);
}

// The slow oracle: every ray against every rectangle, in double precision.
double cast_ray(const World& world, const SE3& pose, const Eigen::Vector3d& ray_in_camera) {
  const Eigen::Vector3d ray = pose.rotation() * ray_in_camera;
  double nearest = 1e9;
  for (const Surface& s : world.surfaces) {
    const Eigen::Vector3d away = s.edge_u.cross(s.edge_v);
    const double facing = away.dot(ray);
    if (facing <= 0.0) continue;
    const double z = away.dot(s.corner - pose.translation()) / facing;
    const Eigen::Vector3d on = pose.translation() + z * ray - s.corner;
    const double u = on.dot(s.edge_u) / s.edge_u.squaredNorm(),
                 v = on.dot(s.edge_v) / s.edge_v.squaredNorm();
    if (z > 0.05 && z < nearest && u >= 0 && u <= 1 && v >= 0 && v <= 1) nearest = z;
  }
  return nearest;
}

class RoomRenderer : public testing::Test {
 protected:
  static void SetUpTestSuite() {
    layout_ = new Layout(make_layout("room", 3));
    world_ = new World(build_world(*layout_, 3, 2));
  }
  static void TearDownTestSuite() {
    delete layout_;
    delete world_;
  }
  static Layout* layout_;
  static World* world_;
};
Layout* RoomRenderer::layout_ = nullptr;
World* RoomRenderer::world_ = nullptr;

TEST_F(RoomRenderer, AgreesWithCastingEveryRay) {
  const CameraPath path(*layout_, PathOptions(), 1);
  const Camera camera = small_camera();
  int compared = 0, different = 0;
  for (const double part : {0.1, 0.45, 0.8}) {
    const SE3 pose = path.world_from_camera(path.duration() * part);
    const Rendering r = render(*world_, {}, camera, pose, {});
    for (int y = 0; y < camera.height; y += 3) {
      for (int x = 0; x < camera.width; x += 3) {
        const double z = cast_ray(*world_, pose, camera.unproject({x, y}, 1.0));
        ++compared;
        different += std::abs(z - r.depth.at<float>(y, x)) > 1e-4 * z;
      }
    }
  }
  EXPECT_LE(different, compared / 1000);  // rays that graze a border
}

TEST_F(RoomRenderer, ThreadsChangeNothing) {
  const CameraPath path(*layout_, PathOptions(), 1);
  const SE3 pose = path.world_from_camera(7.0);
  const Rendering serial = render(*world_, {}, small_camera(), pose, {});
  for (const int threads : {2, 3, 7}) {
    RenderOptions options;
    options.threads = threads;
    const Rendering parallel = render(*world_, {}, small_camera(), pose, options);
    EXPECT_TRUE(same(serial.radiance, parallel.radiance));
    EXPECT_TRUE(same(serial.depth, parallel.depth));
    EXPECT_TRUE(same(serial.incidence, parallel.incidence));
    EXPECT_TRUE(same(serial.surface, parallel.surface));
  }
}

TEST_F(RoomRenderer, BuildingWithThreadsChangesNothing) {
  const World serial = build_world(*layout_, 3, 1);
  ASSERT_EQ(serial.surfaces.size(), world_->surfaces.size());
  const CameraPath path(*layout_, PathOptions(), 1);
  const SE3 pose = path.world_from_camera(3.0);
  EXPECT_TRUE(same(render(serial, {}, small_camera(), pose, {}).radiance,
                   render(*world_, {}, small_camera(), pose, {}).radiance));
}

TEST_F(RoomRenderer, TheRoomIsClosed) {
  const CameraPath path(*layout_, PathOptions(), 1);
  for (double t = 0.0; t < path.duration(); t += 1.7) {
    const Rendering r = render(*world_, {}, small_camera(), path.world_from_camera(t), {});
    EXPECT_EQ(cv::countNonZero(r.surface < 0), 0) << "at " << t << " s";
  }
}

}  // namespace
}  // namespace dxslam
