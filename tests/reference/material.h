#pragma once

// Elastoplastic snow [M 21, 22, 29-32]: energy, stress, and how a particle's deformation follows the velocity gradient.

#include <cmath>

#include "tests/reference/particles.h"
#include "tests/reference/svd.h"

namespace firn::reference {

struct Material {
  double young = 1.4e5;                  // E, Pa
  double poisson = 0.2;                  // nu
  double hardening = 10;                 // xi
  double critical_compression = 2.5e-2;  // theta_c
  double critical_stretch = 7.5e-3;      // theta_s
  double density = 400;                  // kg/m3, initial
};

struct Lame {
  double mu, lambda;  // Pa
};

// mu0 and lambda0.
inline Lame lame(const Material& m) {
  return {m.young / (2 * (1 + m.poisson)), m.young * m.poisson / ((1 + m.poisson) * (1 - 2 * m.poisson))};
}

// mu and lambda of snow whose plastic part has the determinant J_P.
inline Lame hardened(const Material& m, double plastic_det) {
  const double factor = std::exp(m.hardening * (1 - plastic_det));
  return {lame(m).mu * factor, lame(m).lambda * factor};
}

// J F^{-T}, also where F has no inverse.
inline Matrix3d cofactor(const Matrix3d& f) {
  Matrix3d result;
  result.col(0) = f.col(1).cross(f.col(2));
  result.col(1) = f.col(2).cross(f.col(0));
  result.col(2) = f.col(0).cross(f.col(1));
  return result;
}

// Psi, J per m3 of undeformed snow.
inline double energy_density(const Matrix3d& elastic, const Lame& l) {
  const double j = elastic.determinant();
  return l.mu * (elastic - polar_rotation(elastic)).squaredNorm() + l.lambda / 2 * (j - 1) * (j - 1);
}

// P = dPsi/dFE, Pa.
inline Matrix3d first_piola_kirchhoff(const Matrix3d& elastic, const Lame& l) {
  return 2 * l.mu * (elastic - polar_rotation(elastic)) + l.lambda * (elastic.determinant() - 1) * cofactor(elastic);
}

// Step 3, the particle's share: tau_p = V_p0 P(FE_p) FE_p^T, in J, one 3x3 per particle.
inline std::vector<Matrix3d> stress(const Particles& particles, const std::vector<Material>& materials) {
  std::vector<Matrix3d> result;
  for (int p = 0; p < particles.count(); ++p) {
    const Lame l = hardened(materials.at(particles.material[p]), particles.plastic_det[p]);
    result.push_back(particles.volume[p] * first_piola_kirchhoff(particles.elastic[p], l) * particles.elastic[p].transpose());
  }
  return result;
}

// Phi = sum_p V_p0 Psi, J.
inline double elastic_energy(const Particles& particles, const std::vector<Material>& materials) {
  double sum = 0;
  for (int p = 0; p < particles.count(); ++p) {
    const Lame l = hardened(materials.at(particles.material[p]), particles.plastic_det[p]);
    sum += particles.volume[p] * energy_density(particles.elastic[p], l);
  }
  return sum;
}

// Step 8 [M 21, 22]. `gradient`: grad v_p, 1/s. The product det(FE) J_P is what the velocity gradient makes of it: what the clamp
// takes from FE goes to J_P. (A trial that is turned inside out therefore leaves a negative J_P.)
inline void deform(Particles& particles, const std::vector<Matrix3d>& gradient, const std::vector<Material>& materials, double dt) {
  for (int p = 0; p < particles.count(); ++p) {
    const Material& m = materials.at(particles.material[p]);
    const Matrix3d trial = (Matrix3d::Identity() + dt * gradient[p]) * particles.elastic[p];
    const Svd parts = svd(trial);
    const Vector3d kept = parts.s.cwiseMax(1 - m.critical_compression).cwiseMin(1 + m.critical_stretch);
    particles.elastic[p] = parts.u * kept.asDiagonal() * parts.v.transpose();
    particles.plastic_det[p] *= trial.determinant() / particles.elastic[p].determinant();
  }
}

}  // namespace firn::reference
