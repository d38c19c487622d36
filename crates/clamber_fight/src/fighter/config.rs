use clamber_climber::ClimberConfig;
use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::error::{ArenaError, not_negative, positive, within};

/// A fighter's body and weapons. A fighter does not have a weapon that is `None`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct FighterConfig {
    /// Size and abilities of the fighter's body.
    pub climber: ClimberConfig,
    /// The sword; `None` for a fighter without one.
    pub sword: Option<SwordConfig>,
    /// The bow; `None` for a fighter without one.
    pub bow: Option<BowConfig>,
    /// Stones to throw, as many as the fighter likes; `None` for a fighter that throws none.
    pub stones: Option<StoneConfig>,
    /// Damage while obstacles leave the body too little room; `None` for a fighter that takes none.
    pub crush: Option<CrushConfig>,
    /// Hit-stop: seconds for which an impact of its blade holds the fighter still; 0.1 by default. The creature is
    /// never held, since its riders would feel it.
    pub hit_stop: f64,
    /// Seconds from a fighter's death until it lives again, unhurt, at its spawn point; `None` for never. 4 by default.
    pub respawn: Option<f64>,
}

/// A sword: its measures, how long its cuts and stabs take, and their damage.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SwordConfig {
    /// Shoulder, from the centre of the climber's ball: right, up, and ahead of the body
    /// ([`FighterFrame`](crate::FighterFrame)), metres. The arm and the blade of a cut turn about it. Stabs and the
    /// carried sword do not depend on it.
    pub shoulder: DVec3,
    /// Distance from the shoulder to the hilt in a cut, in which the arm is straight, metres; 0.6 by default. A cut
    /// reaches this far plus the blade's length. Stabs and the carried sword do not depend on it.
    pub arm: f64,
    /// Length of the blade, metres; 1.2 by default.
    pub blade: f64,
    /// Radius of the blade as a capsule, metres; 0.02 by default.
    pub radius: f64,
    /// Seconds from the button to the beginning of the blade's arc; 0.15 by default.
    pub wind_up: f64,
    /// Seconds of the blade's arc; 0.175 by default.
    pub cut: f64,
    /// Seconds from the end of the arc until the next act can begin; 0.25 by default.
    pub recover: f64,
    /// Angle of the arc, from right to left, radians; 200 degrees by default.
    pub angle: f64,
    /// Damage of a cut, in the unit of weak points' hit points
    /// ([`WeakPointFile::hit_points`](clamber_colossus::WeakPointFile::hit_points)); 0.1 by default.
    pub cut_damage: f64,
    /// Seconds from the first press of the stab button until the sword is raised, and the stab begins to charge; 0.3 by
    /// default.
    pub raise: f64,
    /// Seconds of charging after which a stab has its full strength; 2 by default.
    pub charge: f64,
    /// Factor on the charge's growth while the button stays down; 1.25 by default.
    pub pressed: f64,
    /// Seconds from the second press of the stab button until the stab lands; 0.12 by default. The first press raises
    /// the sword ([`STAB`](crate::actions::STAB)). A stab in a fall lands on contact instead.
    pub strike: f64,
    /// Length of the ray by which a stab looks for skin, metres; 1.8 by default. It begins beside the climber's ball.
    pub reach: f64,
    /// How deep the blade is in the skin while it is pulled out after a stab, for drawing it, metres; 0.4 by default,
    /// and at most the blade's length. It changes neither the stab's reach nor its damage.
    pub depth: f64,
    /// Seconds to pull the blade out after a stab by a fighter that stands or holds on; 0.6 by default. After a stab
    /// into the air it takes as long.
    pub pull_out: f64,
    /// Seconds to pull the blade out after a stab in a fall, in which the fighter comes down on the creature with the
    /// blade below its body ([`WeaponAction::Plunge`](crate::WeaponAction::Plunge)); 1.6 by default.
    pub pull_out_fallen: f64,
    /// Damage of a fully charged stab, in the unit of weak points' hit points, as `cut_damage`; 1 by default. It is
    /// proportional to the charge.
    pub stab_damage: f64,
}

/// A bow and its arrows.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct BowConfig {
    /// Tip of an arrow when it is released, from the centre of the climber's ball: right, up, and ahead of the body
    /// ([`FighterFrame`](crate::FighterFrame)), metres. The aim does not turn it.
    pub nock: DVec3,
    /// Seconds until the bow is fully drawn; 1 by default.
    pub draw: f64,
    /// Smallest share of a full draw, 0 to 1, at which the bow shoots; 0.2 by default. If the button is released
    /// sooner, no arrow leaves.
    pub least_draw: f64,
    /// Speed of an arrow from a fully drawn bow when it is released, relative to the fighter, metres a second; 56.4 by
    /// default. It is proportional to the draw.
    pub speed: f64,
    /// Drag, 1/m: the deceleration is this times the square of the speed; 0 by default. An arrow of 20 g, with a shaft
    /// of 5.5 mm in diameter, has 0.0011.
    pub drag: f64,
    /// Radius of an arrow's tip, metres; 0.005 by default.
    pub radius: f64,
    /// How deep an arrow sticks in skin or terrain, metres; 0.15 by default.
    pub depth: f64,
    /// Damage of an arrow that meets the skin at [`BowConfig::speed`], in the unit of weak points' hit points
    /// ([`WeakPointFile::hit_points`](clamber_colossus::WeakPointFile::hit_points)); 0.05 by default. It is
    /// proportional to the square of the arrow's speed relative to the skin.
    pub damage: f64,
    /// Largest angle by which an arrow strays, radians for each metre a second at which the archer moves relative to
    /// its support; 0.004 by default. An arrow never strays by more than 0.5 radians.
    pub stray: f64,
    /// Number of arrows at first, and again after each respawn; `None`, the default, for unlimited arrows.
    pub arrows: Option<u32>,
}

/// Stones to throw. They do no damage, but creatures hear them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct StoneConfig {
    /// Position of a stone when it is released, from the centre of the climber's ball: right, up, and ahead of the body
    /// ([`FighterFrame`](crate::FighterFrame)), metres. The aim does not turn it.
    pub hand: DVec3,
    /// Speed of a stone when it leaves the hand, relative to the fighter, metres a second; 18 by default.
    pub speed: f64,
    /// Radius of a stone, a ball, metres; 0.05 by default.
    pub radius: f64,
    /// Loudness of a stone's impact, which creatures hear, in units of the game; 2 by default. It is the loudness of a
    /// [`Noise`](clamber_colossus::Noise): brains compare what arrives of it with numbers of their own.
    pub loudness: f64,
    /// Seconds from a throw until the next act can begin; 0.8 by default.
    pub again: f64,
}

/// Damage to a fighter while obstacles leave its body too little room: from when on, and how much.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CrushConfig {
    /// How much room may be missing between obstacles, beyond the climber's margin, before it does harm, metres; 0.05
    /// by default.
    pub depth: f64,
    /// Hit points, of which a fighter has 1, that it loses per second while it is crushed; 1 by default.
    pub damage: f64,
}

impl FighterConfig {
    /// A fighter with all weapons and [`ClimberConfig::colossus_climber`]. The default.
    pub const fn hero() -> Self {
        Self {
            climber: ClimberConfig::colossus_climber(),
            sword: Some(SwordConfig::DEFAULT),
            bow: Some(BowConfig::DEFAULT),
            stones: Some(StoneConfig::DEFAULT),
            crush: Some(CrushConfig::DEFAULT),
            hit_stop: 0.1,
            respawn: Some(4.0),
        }
    }

    pub(crate) fn check(&self) -> Result<(), ArenaError> {
        if let Some(sword) = &self.sword {
            sword.check()?;
        }
        if let Some(bow) = &self.bow {
            bow.check()?;
        }
        if let Some(stones) = &self.stones {
            stones.check()?;
        }
        if let Some(crush) = &self.crush {
            not_negative("crush.depth", crush.depth)?;
            not_negative("crush.damage", crush.damage)?;
        }
        within("hit_stop", "from 0 to 10", self.hit_stop, [0.0, 10.0])?;
        not_negative("respawn", self.respawn.unwrap_or(0.0))
    }
}

impl Default for FighterConfig {
    fn default() -> Self {
        Self::hero()
    }
}

impl SwordConfig {
    /// The default sword, as a constant for [`FighterConfig::hero`].
    const DEFAULT: Self = Self {
        shoulder: DVec3::new(0.2, 0.9, 0.0),
        arm: 0.6,
        blade: 1.2,
        radius: 0.02,
        wind_up: 0.15,
        cut: 0.175,
        recover: 0.25,
        angle: 200.0 / 180.0 * core::f64::consts::PI,
        cut_damage: 0.1,
        raise: 0.3,
        charge: 2.0,
        pressed: 1.25,
        strike: 0.12,
        reach: 1.8,
        depth: 0.4,
        pull_out: 0.6,
        pull_out_fallen: 1.6,
        stab_damage: 1.0,
    };

    fn check(&self) -> Result<(), ArenaError> {
        place("sword.shoulder", self.shoulder)?;
        not_negative("sword.arm", self.arm)?;
        positive("sword.blade", self.blade)?;
        positive("sword.radius", self.radius)?;
        not_negative("sword.wind_up", self.wind_up)?;
        positive("sword.cut", self.cut)?;
        not_negative("sword.recover", self.recover)?;
        let turn = core::f64::consts::TAU;
        let range = "in radians, from 0 to 6.2832 (a turn)";
        within("sword.angle", range, self.angle, [0.0, turn])?;
        not_negative("sword.cut_damage", self.cut_damage)?;
        not_negative("sword.raise", self.raise)?;
        positive("sword.charge", self.charge)?;
        within("sword.pressed", "from 1 to 100", self.pressed, [1.0, 100.0])?;
        positive("sword.strike", self.strike)?;
        positive("sword.reach", self.reach)?;
        not_negative("sword.depth", self.depth)?;
        not_negative("sword.pull_out", self.pull_out)?;
        not_negative("sword.pull_out_fallen", self.pull_out_fallen)?;
        not_negative("sword.stab_damage", self.stab_damage)
    }
}

impl Default for SwordConfig {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl BowConfig {
    /// The default bow, as a constant for [`FighterConfig::hero`].
    const DEFAULT: Self = Self {
        nock: DVec3::new(0.0, 1.0, 0.6),
        draw: 1.0,
        least_draw: 0.2,
        speed: 56.4,
        drag: 0.0,
        radius: 0.005,
        depth: 0.15,
        damage: 0.05,
        stray: 0.004,
        arrows: None,
    };

    fn check(&self) -> Result<(), ArenaError> {
        place("bow.nock", self.nock)?;
        positive("bow.draw", self.draw)?;
        within("bow.least_draw", "from 0 to 1", self.least_draw, [0.0, 1.0])?;
        within("bow.speed", "from 0 to 10,000", self.speed, [0.0, 1e4])?;
        within("bow.drag", "from 0 to 1", self.drag, [0.0, 1.0])?;
        positive("bow.radius", self.radius)?;
        not_negative("bow.depth", self.depth)?;
        not_negative("bow.damage", self.damage)?;
        let range = "in radians for each m/s, not negative and finite";
        within("bow.stray", range, self.stray, [0.0, f64::MAX])
    }
}

impl Default for BowConfig {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl StoneConfig {
    /// The default stones, as a constant for [`FighterConfig::hero`].
    const DEFAULT: Self = Self {
        hand: DVec3::new(0.3, 1.2, 0.4),
        speed: 18.0,
        radius: 0.05,
        loudness: 2.0,
        again: 0.8,
    };

    fn check(&self) -> Result<(), ArenaError> {
        place("stones.hand", self.hand)?;
        within("stones.speed", "from 0 to 10,000", self.speed, [0.0, 1e4])?;
        positive("stones.radius", self.radius)?;
        not_negative("stones.loudness", self.loudness)?;
        not_negative("stones.again", self.again)
    }
}

impl Default for StoneConfig {
    fn default() -> Self {
        Self::DEFAULT
    }
}

impl CrushConfig {
    /// The default harm, as a constant for [`FighterConfig::hero`].
    const DEFAULT: Self = Self {
        depth: 0.05,
        damage: 1.0,
    };
}

impl Default for CrushConfig {
    fn default() -> Self {
        Self::DEFAULT
    }
}

fn place(name: &'static str, found: DVec3) -> Result<(), ArenaError> {
    for x in found.to_array() {
        within(name, "from -1e6 to 1e6", x, [-1e6, 1e6])?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The error for an angle in degrees tells that radians are expected.
    #[test]
    fn errors_about_angles_name_radians() {
        let sword = SwordConfig {
            angle: 200.0,
            ..SwordConfig::DEFAULT
        };
        let bow = BowConfig {
            stray: -1.0,
            ..BowConfig::DEFAULT
        };
        for refused in [sword.check(), bow.check()] {
            let text = refused.unwrap_err().to_string();
            assert!(text.contains("radians"), "{text}");
        }
    }
}
