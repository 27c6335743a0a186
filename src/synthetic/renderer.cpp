// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "synthetic/renderer.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/error.h"
#include "core/parallel.h"

namespace dxslam {
namespace {

constexpr double kNear = 0.05;  // metres

/// A function a * x + b * y + c of the pixel.
struct Linear {
  double a = 0.0, b = 0.0, c = 0.0;
  double at(double x, double y) const { return a * x + b * y + c; }
};

/// A surface as the camera sees it. With s the inverse depth of the plane at a pixel, the position
/// on the rectangle is u = u_num / s - u_shift, v = v_num / s - v_shift.
struct Projected {
  int index = 0;  // world surfaces first, then the extra ones
  const Surface* surface = nullptr;
  Linear inverse_depth, u_num, v_num;
  double u_shift = 0.0, v_shift = 0.0;
  Eigen::Vector3f normal;  // in camera, towards it
  std::vector<Eigen::Vector2d> outline;
  double y_min = 0.0, y_max = 0.0;
};

// Gamma-encoded value times 16 to linear light.
using LinearTable = std::array<float, 256 * 16 + 1>;

LinearTable linear_table() {
  LinearTable table{};
  for (std::size_t i = 0; i < table.size(); ++i) {
    table[i] = static_cast<float>(std::pow(static_cast<double>(i) / (255.0 * 16.0), 2.2));
  }
  return table;
}

Linear pixel_function(const Eigen::Vector3d& ray_weights, const Camera& camera, double scale) {
  Linear f;
  f.a = scale * ray_weights.x() / camera.fx;
  f.b = scale * ray_weights.y() / camera.fy;
  f.c = scale * ray_weights.z() - f.a * camera.cx - f.b * camera.cy;
  return f;
}

std::vector<Eigen::Vector3d> clip_near(const std::array<Eigen::Vector3d, 4>& corners) {
  std::vector<Eigen::Vector3d> kept;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Eigen::Vector3d &p = corners[i], &q = corners[(i + 1) % corners.size()];
    if (p.z() >= kNear) kept.push_back(p);
    if ((p.z() >= kNear) != (q.z() >= kNear)) {
      kept.push_back(p + (q - p) * ((kNear - p.z()) / (q.z() - p.z())));
    }
  }
  return kept;
}

/// False if the surface cannot be seen.
bool project(const Surface& surface, const Camera& camera, const SE3& camera_from_world,
             Projected& out) {
  const Eigen::Vector3d corner = camera_from_world * surface.corner;
  const Eigen::Vector3d u = camera_from_world.rotation() * surface.edge_u;
  const Eigen::Vector3d v = camera_from_world.rotation() * surface.edge_v;
  const Eigen::Vector3d away = u.cross(v);
  const double distance = away.dot(corner);
  if (distance <= 1e-9) return false;
  const auto polygon = clip_near({corner, corner + u, corner + u + v, corner + v});
  if (polygon.size() < 3) return false;
  out.surface = &surface;
  out.outline.clear();
  double x_min = 1e9, x_max = -1e9;
  out.y_min = 1e9;
  out.y_max = -1e9;
  for (const Eigen::Vector3d& p : polygon) {
    const Eigen::Vector2d pixel = camera.project(p);
    x_min = std::min(x_min, pixel.x());
    x_max = std::max(x_max, pixel.x());
    out.y_min = std::min(out.y_min, pixel.y());
    out.y_max = std::max(out.y_max, pixel.y());
    out.outline.push_back(pixel);
  }
  if (x_max < -1.0 || x_min > camera.width || out.y_max < -1.0 || out.y_min > camera.height) {
    return false;
  }
  out.inverse_depth = pixel_function(away, camera, 1.0 / distance);
  out.u_num = pixel_function(u, camera, 1.0 / u.squaredNorm());
  out.v_num = pixel_function(v, camera, 1.0 / v.squaredNorm());
  out.u_shift = corner.dot(u) / u.squaredNorm();
  out.v_shift = corner.dot(v) / v.squaredNorm();
  out.normal = -away.normalized().cast<float>();
  return true;
}

/// The pixels [begin, end) of row y that lie within the outline.
void row_span(const Projected& p, double y, int width, int& begin, int& end) {
  double left = 1e9, right = -1e9;
  const std::size_t n = p.outline.size();
  for (std::size_t i = 0; i < n; ++i) {
    const Eigen::Vector2d &a = p.outline[i], &b = p.outline[(i + 1) % n];
    if ((a.y() <= y) == (b.y() <= y)) continue;
    const double x = a.x() + (b.x() - a.x()) * ((y - a.y()) / (b.y() - a.y()));
    left = std::min(left, x);
    right = std::max(right, x);
  }
  begin = left > right ? 0 : static_cast<int>(std::ceil(std::clamp(left, 0.0, width * 1.0)));
  end = left > right ? 0 : static_cast<int>(std::ceil(std::clamp(right, 0.0, width * 1.0)));
}

class Painter {
 public:
  Painter(const World& world, const std::vector<Surface>& extra, const Camera& camera,
          const SE3& world_from_camera, const RenderOptions& options)
      : world_(world), camera_(camera), options_(options) {
    camera_.cx -= options.shift_x;
    camera_.cy -= options.shift_y;
    const SE3 camera_from_world = world_from_camera.inverse();
    Projected projected;
    const auto add = [&](const std::vector<Surface>& surfaces, std::size_t base) {
      for (std::size_t i = 0; i < surfaces.size(); ++i) {
        if (!project(surfaces[i], camera_, camera_from_world, projected)) continue;
        projected.index = static_cast<int>(base + i);
        visible_.push_back(projected);
      }
    };
    add(world.surfaces, 0);
    add(extra, world.surfaces.size());
  }

  Rendering paint() {
    Rendering out;
    out.radiance.create(camera_.height, camera_.width, CV_32FC3);
    out.depth.create(camera_.height, camera_.width, CV_32FC1);
    out.incidence.create(camera_.height, camera_.width, CV_32FC1);
    out.surface.create(camera_.height, camera_.width, CV_32SC1);
    nearest_.create(camera_.height, camera_.width, CV_32SC1);
    inverse_depth_.create(camera_.height, camera_.width, CV_32FC1);
    parallel_ranges(camera_.height, options_.threads,
                    [&](int begin, int end) { find_nearest(begin, end); });
    in_parallel(static_cast<std::size_t>(camera_.height), options_.threads,
                [&](std::size_t y) { shade_row(static_cast<int>(y), out); });
    return out;
  }

 private:
  void find_nearest(int row_begin, int row_end) {
    for (int y = row_begin; y < row_end; ++y) {
      std::fill_n(nearest_.ptr<int>(y), camera_.width, -1);
      std::fill_n(inverse_depth_.ptr<float>(y), camera_.width, 0.0F);
    }
    for (int k = 0; k < static_cast<int>(visible_.size()); ++k) {
      const Projected& p = visible_[k];
      const int first = std::max(row_begin, static_cast<int>(std::floor(p.y_min)));
      const int last = std::min<double>(row_end - 1, std::ceil(p.y_max));
      for (int y = first; y <= last; ++y) {
        int begin = 0, end = 0;
        row_span(p, y, camera_.width, begin, end);
        const float base = static_cast<float>(p.inverse_depth.at(0.0, y));
        const float slope = static_cast<float>(p.inverse_depth.a);
        float* inverse_depth = inverse_depth_.ptr<float>(y);
        int* nearest = nearest_.ptr<int>(y);
        for (int x = begin; x < end; ++x) {
          const float s = base + slope * static_cast<float>(x);
          const bool closer = s > inverse_depth[x];
          inverse_depth[x] = closer ? s : inverse_depth[x];
          nearest[x] = closer ? k : nearest[x];
        }
      }
    }
  }

  void shade_row(int y, Rendering& out) const {
    const int* nearest = nearest_.ptr<int>(y);
    for (int x = 0; x < camera_.width; ++x) {
      const int k = nearest[x];
      out.surface.at<int>(y, x) = k < 0 ? -1 : visible_[k].index;
      float& depth = out.depth.at<float>(y, x);
      float& incidence = out.incidence.at<float>(y, x);
      depth = 0.0F;
      incidence = 0.0F;
      if (k >= 0) {
        const Projected& p = visible_[k];
        depth = static_cast<float>(1.0 / p.inverse_depth.at(x, y));
        const Eigen::Vector3f ray(static_cast<float>((x - camera_.cx) / camera_.fx),
                                  static_cast<float>((y - camera_.cy) / camera_.fy), 1.0F);
        incidence = -p.normal.dot(ray) / ray.norm();
      }
      out.radiance.at<cv::Vec3f>(y, x) =
          options_.antialias && on_border(x, y) ? border_color(x, y) : color_of(k, x, y);
    }
  }

  bool on_border(int x, int y) const {
    const int k = nearest_.at<int>(y, x);
    return (x > 0 && nearest_.at<int>(y, x - 1) != k) ||
           (x + 1 < camera_.width && nearest_.at<int>(y, x + 1) != k) ||
           (y > 0 && nearest_.at<int>(y - 1, x) != k) ||
           (y + 1 < camera_.height && nearest_.at<int>(y + 1, x) != k);
  }

  /// Mean over four places within the pixel, each of the nearest among the surfaces around.
  cv::Vec3f border_color(int x, int y) const {
    std::array<int, 9> candidates{};
    int count = 0;
    for (int row = std::max(y - 1, 0); row <= std::min(y + 1, camera_.height - 1); ++row) {
      for (int col = std::max(x - 1, 0); col <= std::min(x + 1, camera_.width - 1); ++col) {
        const int k = nearest_.at<int>(row, col);
        const auto end = candidates.begin() + count;
        if (k >= 0 && std::find(candidates.begin(), end, k) == end) candidates[count++] = k;
      }
    }
    static constexpr double kPlaces[4][2] = {
        {-0.125, -0.375}, {0.375, -0.125}, {0.125, 0.375}, {-0.375, 0.125}};
    cv::Vec3f sum(0, 0, 0);
    for (const auto& place : kPlaces) {
      const double px = x + place[0], py = y + place[1];
      int best = nearest_.at<int>(y, x);
      double best_inverse_depth = 0.0;
      for (int i = 0; i < count; ++i) {
        const double s = visible_[candidates[i]].inverse_depth.at(px, py);
        if (s > best_inverse_depth && covers(visible_[candidates[i]], px, py, s)) {
          best_inverse_depth = s;
          best = candidates[i];
        }
      }
      sum += color_of(best, px, py);
    }
    return sum * 0.25F;
  }

  static bool covers(const Projected& p, double x, double y, double s) {
    const double u = p.u_num.at(x, y) / s - p.u_shift, v = p.v_num.at(x, y) / s - p.v_shift;
    return u >= 0.0 && u <= 1.0 && v >= 0.0 && v <= 1.0;
  }

  cv::Vec3f color_of(int k, double x, double y) const {
    if (k < 0) return {0, 0, 0};
    static const LinearTable linear = linear_table();
    const Projected& p = visible_[k];
    const Surface& surface = *p.surface;
    const double z = 1.0 / p.inverse_depth.at(x, y);
    const double u_on_plane = p.u_num.at(x, y) * z, v_on_plane = p.v_num.at(x, y) * z;
    const float u = std::clamp(static_cast<float>(u_on_plane - p.u_shift), 0.0F, 1.0F);
    const float v = std::clamp(static_cast<float>(v_on_plane - p.v_shift), 0.0F, 1.0F);
    const auto step = [z](double num, double on_plane, double inverse_depth) {
      return static_cast<float>((num - on_plane * inverse_depth) * z);
    };
    const Eigen::Vector2f repeat = surface.repeat;
    float bgr[3];
    world_.textures[surface.texture].sample(
        u * repeat.x() + surface.offset.x(), v * repeat.y() + surface.offset.y(),
        step(p.u_num.a, u_on_plane, p.inverse_depth.a) * repeat.x(),
        step(p.v_num.a, v_on_plane, p.inverse_depth.a) * repeat.y(),
        step(p.u_num.b, u_on_plane, p.inverse_depth.b) * repeat.x(),
        step(p.v_num.b, v_on_plane, p.inverse_depth.b) * repeat.y(), surface.tiled, bgr);
    const Eigen::Vector3f light = light_at(surface.light, u, v) * world_.exposure;
    cv::Vec3f color;
    for (int c = 0; c < 3; ++c) {
      color[c] = linear[static_cast<int>(bgr[c] * 16.0F + 0.5F)] * light[c];
    }
    return color;
  }

  static Eigen::Vector3f light_at(const LightGrid& grid, float u, float v) {
    const float x = u * static_cast<float>(grid.columns - 1);
    const float y = v * static_cast<float>(grid.rows - 1);
    const int x0 = std::min(static_cast<int>(x), grid.columns - 2);
    const int y0 = std::min(static_cast<int>(y), grid.rows - 2);
    const float fx = x - static_cast<float>(x0), fy = y - static_cast<float>(y0);
    const Eigen::Vector3f* node =
        grid.nodes.data() + static_cast<std::size_t>(y0) * grid.columns + x0;
    const Eigen::Vector3f top = node[0] + fx * (node[1] - node[0]);
    const Eigen::Vector3f bottom =
        node[grid.columns] + fx * (node[grid.columns + 1] - node[grid.columns]);
    return top + fy * (bottom - top);
  }

  const World& world_;
  Camera camera_;
  RenderOptions options_;
  std::vector<Projected> visible_;
  cv::Mat nearest_;  // index into visible_
  cv::Mat inverse_depth_;
};

}  // namespace

Rendering render(const World& world, const std::vector<Surface>& extra, const Camera& camera,
                 const SE3& world_from_camera, const RenderOptions& options) {
  require(!camera.has_distortion(), "the renderer needs a camera without distortion");
  return Painter(world, extra, camera, world_from_camera, options).paint();
}

}  // namespace dxslam
