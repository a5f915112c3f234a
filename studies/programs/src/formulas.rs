//! The steps and the models as formulas, in LaTeX: what the report typesets. A method without a formula does not compile.

use integrator::methods::{MethodId, RigidStep};
use integrator::rigid_body::Storage;

/// A step from (t0, q0, v0) to (t1, q1, v1), one line each; a is the rate of v, w the velocity of q.
pub fn of_method(method: MethodId) -> &'static [&'static str] {
    match method {
        MethodId::ExplicitEuler => &[r"q_1 = q_0 + h\,v_0,\quad v_1 = v_0 + h\,a(t_0, q_0, v_0)"],
        MethodId::SemiImplicitEuler => &[r"v_1 = v_0 + h\,a(t_0, q_0, v_0),\quad q_1 = q_0 + h\,v_1"],
        MethodId::VelocityVerlet => &[
            r"a_0 = a(t_0, q_0, v_0),\quad q_1 = q_0 + h\,v_0 + \tfrac{h^2}{2}\,a_0",
            r"a_1 = a(t_1, q_1, v_0 + h\,a_0),\quad v_1 = v_0 + \tfrac{h}{2}\,(a_0 + a_1)",
        ],
        MethodId::Rk4 => &[
            r"a_1 = a(t_0, q_0, v_0),\quad w_1 = v_0",
            r"a_2 = a(t_0 + \tfrac{h}{2}, q_0 + \tfrac{h}{2} w_1, v_0 + \tfrac{h}{2} a_1),\quad w_2 = v_0 + \tfrac{h}{2} a_1",
            r"a_3 = a(t_0 + \tfrac{h}{2}, q_0 + \tfrac{h}{2} (w_2 - \tfrac{h}{4} [w_1, w_2]), v_0 + \tfrac{h}{2} a_2),\quad w_3 = v_0 + \tfrac{h}{2} a_2",
            r"a_4 = a(t_1, q_0 + h w_3, v_0 + h a_3),\quad w_4 = v_0 + h a_3",
            r"q_1 = q_0 + \tfrac{h}{6} (w_1 + 2 w_2 + 2 w_3 + w_4 - \tfrac{h}{2} [w_1, w_4]),\quad v_1 = v_0 + \tfrac{h}{6} (a_1 + 2 a_2 + 2 a_3 + a_4)",
        ],
        MethodId::ImplicitEuler => &[r"v_1 = v_0 + h\,a(t_1, q_1, v_1),\quad q_1 = q_0 + h\,v_1"],
        MethodId::ImplicitMidpoint => &[
            r"v_m = \tfrac12\,(v_0 + v_1),\quad q_m = q_0 + \tfrac{h}{2}\,v_m",
            r"v_1 = v_0 + h\,a(t_0 + \tfrac{h}{2}, q_m, v_m),\quad q_1 = q_0 + h\,v_m",
        ],
    }
}

/// Where a method comes from.
pub fn source_of_method(method: MethodId) -> &'static str {
    match method {
        MethodId::ExplicitEuler => "L. Euler, Institutionum calculi integralis I (1768), section 650",
        MethodId::SemiImplicitEuler => {
            "E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration (2006), I.1.2 (1.9)"
        }
        MethodId::VelocityVerlet => {
            "L. Verlet, Phys. Rev. 159 (1967) 98; W. Swope et al., J. Chem. Phys. 76 (1982) 637"
        }
        MethodId::Rk4 => {
            "W. Kutta, Z. Math. Phys. 46 (1901) 435; on rotations H. Munthe-Kaas, B. Owren, Phil. Trans. R. Soc. A 357 (1999) 957"
        }
        MethodId::ImplicitEuler => {
            "E. Hairer, G. Wanner, Solving Ordinary Differential Equations II (1996), IV.1 (1.10)"
        }
        MethodId::ImplicitMidpoint => {
            "E. Hairer, C. Lubich, G. Wanner, Geometric Numerical Integration (2006), I.1.1 (1.7)"
        }
    }
}

/// A step that exists for rigid bodies only.
pub fn of_rigid_step(step: RigidStep) -> &'static [&'static str] {
    match step {
        RigidStep::ImplicitGyroscopic => &[
            r"u = \omega_0 + h\,I^{-1}\tau_0,\quad f(w) = I\,(w - u) + h\,w\times I w",
            r"\omega_1 = u - f'(u)^{-1} f(u),\quad q_1 = q_0\exp(h\,\omega_1)",
        ],
        RigidStep::RestoredMomentum => &[
            r"l = I\omega_0,\quad l^\ast = l + h\,l\times\omega_0",
            r"I\omega_1 = l^\ast\,\frac{|l|}{|l^\ast|} + h\,\tau_0,\quad q_1 = q_0\exp(h\,\omega_1)",
        ],
        RigidStep::MomentumMidpoint => &[
            r"q_m = \exp(\tfrac{h}{2}\,\omega(q_0, L_0))\,q_0,\quad L_m = L_0 + \tfrac{h}{2}\,\tau_0",
            r"L_1 = L_0 + h\,\tau_m,\quad q_1 = \exp(h\,\omega(q_m, L_m))\,q_0",
        ],
        RigidStep::FreeSplitting => &[
            r"X_{h/2}\circ Y_{h/2}\circ Z_h\circ Y_{h/2}\circ X_{h/2}\quad\text{between two kicks}\quad l\to l + \tfrac{h}{2}\,\tau",
            r"X_h: \text{turn by the angle}\ h\,l_x / I_x\ \text{about the body's}\ x\ \text{axis}",
        ],
    }
}

/// The equation of motion that a model of a rigid body integrates.
pub fn of_storage(storage: Storage) -> &'static str {
    match storage {
        Storage::WorldOmega => {
            r"I_w\,\dot\omega = \tau - \omega\times I_w\omega,\quad I_w = R\,I R^{T},\quad \dot q = \tfrac12\,\omega\,q"
        }
        Storage::BodyOmega => r"I\,\dot\omega = \tau + I\omega\times\omega,\quad \dot q = \tfrac12\,q\,\omega",
        Storage::WorldMomentum => r"\dot L = \tau,\quad \omega = R\,I^{-1} R^{T} L,\quad \dot q = \tfrac12\,\omega\,q",
        Storage::WithoutGyroscopicTerm => {
            r"I_w\,\dot\omega = \tau,\quad I_w = R\,I R^{T},\quad \dot q = \tfrac12\,\omega\,q"
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_formula_can_be_typeset() {
        let methods = MethodId::ALL.iter().flat_map(|&m| of_method(m)).copied();
        let steps = RigidStep::ALL.iter().flat_map(|&s| of_rigid_step(s)).copied();
        let stored = Storage::ALL.into_iter().map(of_storage);
        let motions: Vec<_> = scenes::all().iter().map(|scene| scene.scene().info().equation).collect();
        for latex in methods.chain(steps).chain(stored).chain(motions) {
            let mathml = reports::mathml(latex).unwrap_or_else(|error| panic!("{error}"));
            assert!(mathml.contains("<mi>") && mathml.contains("</math>"), "{latex}: {mathml}");
        }
    }
}
