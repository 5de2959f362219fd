// The decomposition of shaders/lib/svd.glsl, by what it must satisfy [M3].

#include <Eigen/Dense>
#include <filesystem>
#include <random>

#include "tests/catch.h"
#include "tests/stages/harness.h"

using namespace firn::test;
using Eigen::Matrix3d;
using Eigen::Matrix3f;

namespace {

struct Kind {
  const char* name;
  Matrix3d (*make)(std::mt19937_64&);
};

double normal(std::mt19937_64& engine) { return std::normal_distribution<double>()(engine); }
Matrix3d random_matrix(std::mt19937_64& engine) {
  Matrix3d m;
  for (int i = 0; i < 9; ++i) m.data()[i] = normal(engine);
  return m;
}
Matrix3d rotation(std::mt19937_64& engine) {
  return Eigen::Quaterniond(normal(engine), normal(engine), normal(engine), normal(engine)).normalized().toRotationMatrix();
}
Eigen::Vector3d random_vector(std::mt19937_64& engine) { return {normal(engine), normal(engine), normal(engine)}; }

const Kind kinds[] = {
    {"random", random_matrix},
    {"near identity", [](std::mt19937_64& e) { return Matrix3d(Matrix3d::Identity() + 1e-4 * random_matrix(e)); }},
    {"rotated", [](std::mt19937_64& e) { return Matrix3d(rotation(e) * (Matrix3d::Identity() + 1e-2 * random_matrix(e))); }},
    {"rotation", rotation},
    {"reflected", [](std::mt19937_64& e) { return Matrix3d(rotation(e) * Eigen::Vector3d(1, 1, -1).asDiagonal() * rotation(e)); }},
    {"rank 1", [](std::mt19937_64& e) { return Matrix3d(random_vector(e) * random_vector(e).transpose()); }},
    {"rank 2",
     [](std::mt19937_64& e) {
       return Matrix3d(rotation(e) * Eigen::Vector3d(normal(e), normal(e), 0).asDiagonal() * rotation(e));
     }},
    {"zero", [](std::mt19937_64&) { return Matrix3d(Matrix3d::Zero()); }},
    {"of very different sizes",
     [](std::mt19937_64& e) { return Matrix3d(std::pow(10, 8 * std::tanh(normal(e))) * random_matrix(e)); }},
    {"diagonal", [](std::mt19937_64& e) { return Matrix3d(random_vector(e).asDiagonal()); }},
};

firn::graph::Registry svd_stage() {
  using namespace firn::graph;
  firn::graph::Registry registry;
  const auto port = [](const char* name, ElementType type, Access access) {
    return Port{.name = name, .type = type, .domain = "matrices", .access = access, .unit = "1", .doc = "of the test"};
  };
  registry.add({.name = "test.svd",
                .doc = "Singular values of matrices",
                .equation = "M3",
                .ports = {port("matrix", ElementType::mat3, Access::read), port("u", ElementType::mat3, Access::write),
                          port("s", ElementType::vec3, Access::write), port("v", ElementType::mat3, Access::write)},
                .work = {Dispatch{.kernel = std::string(FIRN_SOURCE_DIR) + "/tests/stages/shaders/svd.comp", .over = "matrices"}}});
  return registry;
}

Matrix3d row_major(const float* values) {
  return Eigen::Map<const Eigen::Matrix<float, 3, 3, Eigen::RowMajor>>(values).cast<double>();
}

}  // namespace

TEST_CASE("singular values of a million matrices of every kind are accurate in single precision") {
  INFO("seed " << seed());
  std::mt19937_64 engine(seed());
  constexpr std::size_t per_kind = 100000;
  for (const Kind& kind : kinds) {
    std::vector<float> matrices;
    for (std::size_t i = 0; i < per_kind; ++i) {
      const Matrix3f m = kind.make(engine).cast<float>();
      for (int k = 0; k < 9; ++k) matrices.push_back(m(k / 3, k % 3));
    }
    firn::graph::Environment environment;
    environment.domains["matrices"] = {per_kind};
    environment.provided = {"matrix", "u", "s", "v"};
    Arrays in;
    in.floats["matrix"] = matrices;
    const Arrays out = run_pipeline("firn: 1\nstep: [test.svd]\n", environment, svd_stage(), in, 0, 1);
    double rebuilt = 0, orthogonal = 0, determinant = 0, order = 0;
    for (std::size_t i = 0; i < per_kind; ++i) {
      const Matrix3d f = row_major(&matrices[9 * i]), u = row_major(&out.floats.at("u")[9 * i]),
                     v = row_major(&out.floats.at("v")[9 * i]);
      const Eigen::Vector3d s = Eigen::Map<const Eigen::Vector3f>(&out.floats.at("s")[3 * i]).cast<double>();
      REQUIRE((u.allFinite() && v.allFinite() && s.allFinite()));
      const double size = f.norm() > 0 ? f.norm() : 1;
      rebuilt = std::max(rebuilt, (f - u * s.asDiagonal() * v.transpose()).norm() / size);
      for (const Matrix3d& q : {u, v}) {
        orthogonal = std::max(orthogonal, (q.transpose() * q - Matrix3d::Identity()).norm());
        determinant = std::max(determinant, std::abs(q.determinant() - 1));
      }
      // Largest first; only the last may be negative. Equal ones may differ by rounding.
      order = std::max({order, (s[1] - s[0]) / size, (std::abs(s[2]) - s[1]) / size, -s[1] / size, -s[0] / size});
    }
    INFO(kind.name);
    CAPTURE(rebuilt, orthogonal, determinant, order);
    CHECK(rebuilt <= 2e-6);
    CHECK(orthogonal <= 2e-6);
    CHECK(determinant <= 1e-5);
    CHECK(order <= 1e-6);
  }
}
