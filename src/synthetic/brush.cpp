// SPDX-License-Identifier: Apache-2.0
// Copyright 2026 The dxslam authors
#include "synthetic/brush.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <vector>

namespace dxslam::brush {
namespace {

/// Where each of `size` places lies among `cells` nodes that repeat: the node before and the share
/// of the next one.
struct Places {
  std::vector<int> before, after;
  std::vector<float> share;
};

Places places_among(int cells, int size) {
  Places places;
  for (int i = 0; i < size; ++i) {
    const double at = (i + 0.5) * cells / size;
    const int node = static_cast<int>(at);
    places.before.push_back(node);
    places.after.push_back((node + 1) % cells);
    places.share.push_back(static_cast<float>(at - node));
  }
  return places;
}

// Adds a random grid, enlarged by straight lines to the size of the image, times strength.
void add_field(cv::Mat& sum, Random& random, int cells_x, int cells_y, float strength) {
  std::vector<float> grid(static_cast<std::size_t>(cells_x) * cells_y);
  for (float& node : grid) node = strength * static_cast<float>(random.uniform(-1.0, 1.0));
  const Places columns = places_among(cells_x, sum.cols), rows = places_among(cells_y, sum.rows);
  std::vector<float> line(static_cast<std::size_t>(cells_x));
  for (int y = 0; y < sum.rows; ++y) {
    const float* above = grid.data() + static_cast<std::size_t>(rows.before[y]) * cells_x;
    const float* below = grid.data() + static_cast<std::size_t>(rows.after[y]) * cells_x;
    for (int i = 0; i < cells_x; ++i) line[i] = above[i] + rows.share[y] * (below[i] - above[i]);
    float* out = sum.ptr<float>(y);
    for (int x = 0; x < sum.cols; ++x) {
      const float left = line[columns.before[x]];
      out[x] += left + columns.share[x] * (line[columns.after[x]] - left);
    }
  }
}

}  // namespace

cv::Mat fractal_noise(Random& random, cv::Size size, int cells_x, int cells_y, int octaves,
                      double gain) {
  cv::Mat sum = cv::Mat::zeros(size, CV_32FC1);
  double strength = 1.0, total = 0.0;
  for (int octave = 0; octave < octaves; ++octave) {
    const int x = std::min(cells_x << octave, size.width);
    const int y = std::min(cells_y << octave, size.height);
    add_field(sum, random, x, y, static_cast<float>(strength));
    total += strength * strength;
    strength *= gain;
  }
  sum.convertTo(sum, CV_32FC1, 1.0 / std::sqrt(total));
  return sum;
}

void add_noise(cv::Mat& image, const cv::Mat& noise, double strength) {
  for (int y = 0; y < image.rows; ++y) {
    cv::Vec3b* row = image.ptr<cv::Vec3b>(y);
    const float* n = noise.ptr<float>(y);
    for (int x = 0; x < image.cols; ++x) {
      const int shift = cvRound(n[x] * strength);
      for (int c = 0; c < 3; ++c) row[x][c] = cv::saturate_cast<uchar>(row[x][c] + shift);
    }
  }
}

void modulate(cv::Mat& image, const cv::Mat& noise, double strength) {
  for (int y = 0; y < image.rows; ++y) {
    cv::Vec3b* row = image.ptr<cv::Vec3b>(y);
    const float* n = noise.ptr<float>(y);
    for (int x = 0; x < image.cols; ++x) {
      const float factor = 1.0F + n[x] * static_cast<float>(strength);
      for (int c = 0; c < 3; ++c) row[x][c] = cv::saturate_cast<uchar>(row[x][c] * factor);
    }
  }
}

cv::Scalar color_of(double hue, double saturation, double value) {
  double bgr[3];
  for (int c = 0; c < 3; ++c) {
    const double phase = std::fmod(hue + (c == 0 ? 1.0 / 3 : c == 1 ? 2.0 / 3 : 0.0), 1.0) * 6.0;
    const double ramp = std::clamp(std::abs(phase - 3.0) - 1.0, 0.0, 1.0);
    bgr[c] = value * (1.0 - saturation * (1.0 - ramp));
  }
  return {bgr[0], bgr[1], bgr[2]};
}

cv::Scalar random_color(Random& random, double min_value, double max_value) {
  const double hue = random.uniform(), saturation = std::pow(random.uniform(), 0.9) * 0.7;
  return color_of(hue, saturation, random.uniform(min_value, max_value));
}

cv::Scalar jitter(Random& random, const cv::Scalar& color, double amount) {
  const double common = random.uniform(-amount, amount);
  cv::Scalar out;
  for (int c = 0; c < 3; ++c) {
    out[c] = std::clamp(color[c] + common + random.uniform(-0.3, 0.3) * amount, 0.0, 255.0);
  }
  return out;
}

std::string random_word(Random& random, int min_length, int max_length) {
  const int length = random.integer(min_length, max_length);
  const int style = random.integer(4);
  std::string word;
  for (int i = 0; i < length; ++i) {
    const char small = static_cast<char>('a' + random.integer(26));
    const char capital = static_cast<char>('A' + random.integer(26));
    const char digit = static_cast<char>('0' + random.integer(10));
    word += style == 0 ? capital : style == 3 ? digit : (i == 0 && style == 1) ? capital : small;
  }
  return word;
}

void write_word(cv::Mat& image, const std::string& word, cv::Point origin, double height,
                const cv::Scalar& color, Random& random) {
  static constexpr int kFonts[] = {cv::FONT_HERSHEY_SIMPLEX, cv::FONT_HERSHEY_DUPLEX,
                                   cv::FONT_HERSHEY_COMPLEX, cv::FONT_HERSHEY_TRIPLEX};
  const int font = kFonts[random.integer(4)];
  const int thickness = std::max(1, static_cast<int>(height * random.uniform(0.08, 0.2)));
  cv::putText(image, word, origin, font, height / 22.0, color, thickness, cv::LINE_AA);
}

void write_lines(cv::Mat& image, cv::Rect area, double line_height, const cv::Scalar& color,
                 Random& random) {
  const int font = random.chance(0.5) ? cv::FONT_HERSHEY_SIMPLEX : cv::FONT_HERSHEY_COMPLEX_SMALL;
  const double scale = line_height * 0.55 / 22.0;
  for (double y = area.y + line_height * 0.8; y < area.br().y; y += line_height) {
    double x = area.x;
    const double end = random.chance(0.2) ? area.x + area.width * random.uniform(0.2, 0.8)
                                          : area.br().x - line_height;
    while (x < end) {
      const std::string word = random_word(random, 2, 8);
      cv::putText(image, word, cv::Point(static_cast<int>(x), static_cast<int>(y)), font, scale,
                  color, 1, cv::LINE_AA);
      x += line_height * (0.5 * static_cast<double>(word.size()) + 0.4);
    }
  }
}

void draw_shape(cv::Mat& image, cv::Rect area, const cv::Scalar& color, Random& random) {
  const int reach = std::max(3, std::min(area.width, area.height) / 2);
  const cv::Point centre(area.x + random.integer(area.width), area.y + random.integer(area.height));
  const int size = std::max(3, static_cast<int>(reach * random.uniform(0.1, 0.6)));
  const int kind = random.integer(5);
  if (kind == 0) {
    const cv::Size axes(size, std::max(2, static_cast<int>(size * random.uniform(0.4, 1.0))));
    cv::ellipse(image, centre, axes, random.uniform(0, 180), 0, 360, color, cv::FILLED,
                cv::LINE_AA);
    return;
  }
  if (kind == 1) {
    cv::circle(image, centre, size, color, std::max(2, size / random.integer(2, 5)), cv::LINE_AA);
    return;
  }
  const int corners = kind == 2 ? 4 : kind == 3 ? random.integer(3, 6) : 2 * random.integer(4, 8);
  const double turn = random.uniform(0, 6.28), flat = random.uniform(0.5, 1.0);
  std::vector<cv::Point> polygon;
  for (int i = 0; i < corners; ++i) {
    const double angle = turn + 6.28318 * i / corners;
    const double radius = kind == 4 && i % 2 == 1 ? 0.45 * size : size;
    polygon.emplace_back(centre.x + static_cast<int>(radius * std::cos(angle)),
                         centre.y + static_cast<int>(radius * flat * std::sin(angle)));
  }
  cv::fillPoly(image, std::vector<std::vector<cv::Point>>{polygon}, color, cv::LINE_AA);
}

void fill_gradient(cv::Mat& image, cv::Rect area, const cv::Scalar& from, const cv::Scalar& to,
                   Random& random) {
  const double angle = random.uniform(0, 6.28);
  const double dx = std::cos(angle) / area.width, dy = std::sin(angle) / area.height;
  for (int y = 0; y < area.height; ++y) {
    cv::Vec3b* row = image.ptr<cv::Vec3b>(area.y + y) + area.x;
    for (int x = 0; x < area.width; ++x) {
      const double t =
          std::clamp(0.5 + (x - area.width / 2.0) * dx + (y - area.height / 2.0) * dy, 0.0, 1.0);
      for (int c = 0; c < 3; ++c) {
        row[x][c] = cv::saturate_cast<uchar>(from[c] + t * (to[c] - from[c]));
      }
    }
  }
}

void draw_landscape(cv::Mat& image, cv::Rect area, Random& random) {
  cv::Mat view = image(area);
  const cv::Rect all(0, 0, area.width, area.height);
  const double hue = random.uniform(0.5, 0.75);
  cv::Mat sky = view;
  fill_gradient(sky, all, color_of(hue, 0.5, 235), color_of(random.uniform(0, 0.15), 0.35, 240),
                random);
  add_noise(sky, fractal_noise(random, area.size(), 3, 5, 5), 22);
  cv::circle(sky, {random.integer(area.width), random.integer(area.height / 2 + 1)},
             area.width / random.integer(9, 16) + 2, color_of(0.14, 0.4, 255), cv::FILLED,
             cv::LINE_AA);
  const int layers = random.integer(3, 5);
  for (int layer = 0; layer < layers; ++layer) {
    const cv::Mat ridge = fractal_noise(random, {std::max(area.width, 2), 4}, 3 + layer, 2, 5, 0.5);
    const double base = area.height * (0.4 + 0.55 * layer / layers);
    const double height = area.height * 0.16;
    std::vector<cv::Point> outline{{0, area.height}};
    for (int x = 0; x < area.width; x += 2) {
      outline.emplace_back(x, static_cast<int>(base - height * ridge.at<float>(0, x)));
    }
    outline.emplace_back(area.width, area.height);
    const cv::Scalar color = color_of(random.uniform(0.2, 0.65), random.uniform(0.2, 0.6),
                                      190.0 - 130.0 * layer / layers);
    cv::fillPoly(view, std::vector<std::vector<cv::Point>>{outline}, color, cv::LINE_AA);
  }
  const int trees = random.integer(6, 16);
  for (int i = 0; i < trees; ++i) {
    const int x = random.integer(area.width),
              foot = area.height - random.integer(area.height / 5 + 1);
    const int size = area.height / random.integer(8, 20) + 2;
    const cv::Scalar green = jitter(random, color_of(random.uniform(0.2, 0.4), 0.6, 90), 40);
    cv::line(view, {x, foot}, {x, foot - 2 * size}, color_of(0.08, 0.5, 60), std::max(1, size / 5));
    cv::ellipse(view, {x, foot - 2 * size}, {size / 2 + 1, size}, 0, 0, 360, green, cv::FILLED,
                cv::LINE_AA);
  }
  modulate(view, fractal_noise(random, area.size(), 40, 40, 3, 0.8), 0.12);
}

void draw_skyline(cv::Mat& image, cv::Rect area, Random& random) {
  cv::Mat view = image(area);
  fill_gradient(view, {0, 0, area.width, area.height}, color_of(0.58, 0.45, 240),
                color_of(0.1, 0.2, 250), random);
  add_noise(view, fractal_noise(random, area.size(), 3, 4, 5), 18);
  for (int depth = 0; depth < 3; ++depth) {
    for (int x = -random.integer(20); x < area.width;) {
      const int width = area.width / random.integer(5, 12) + 4;
      const int top = static_cast<int>(area.height * random.uniform(0.2 + 0.15 * depth, 0.85));
      const cv::Scalar wall =
          color_of(random.uniform(), 0.25, random.uniform(90, 200) - 20 * depth);
      cv::rectangle(view, {x, top}, {x + width, area.height}, wall, cv::FILLED);
      const cv::Scalar glass = jitter(
          random, random.chance(0.5) ? cv::Scalar(70, 60, 50) : cv::Scalar(160, 220, 240), 30);
      const int step = std::max(5, width / random.integer(3, 6));
      for (int wy = top + 3; wy < area.height; wy += step) {
        for (int wx = x + 2; wx + step / 2 < x + width; wx += step) {
          if (random.chance(0.8)) {
            cv::rectangle(view, {wx, wy}, {wx + step / 2, wy + step / 2}, glass, cv::FILLED);
          }
        }
      }
      x += width + random.integer(6);
    }
  }
}

}  // namespace dxslam::brush
