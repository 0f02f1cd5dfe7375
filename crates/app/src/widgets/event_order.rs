//! What the hand does counts in the order and at the place in which it was done, however slow a frame is.
//!
//! egui looks at the pointer and at the Tab key once a frame: a click belongs to the widget, the place and the modifier
//! keys of the frame's end. Where a frame takes long, the pointer has gone elsewhere by then. So a frame is given the
//! events up to a button or the wheel, and no event that would change where or how that counts; the others wait for the
//! next frame, which follows at once. Two clicks in one frame become two frames, so both count, and these frames have the
//! time at which the clicks arrived, so that a double click is one. What is typed before and after a Tab or a click belongs
//! to the fields before and after it.

use eframe::egui::{Context, Event, Key, MouseWheelUnit, Plugin, Pos2, RawInput, Ui};

/// Wheel travel of a touch pad that counts as one line, points.
const LINE: f32 = 24.0;
/// Lines of a page.
const PAGE: f32 = 10.0;

/// Longest time between the two clicks of a double click, seconds: that of most systems.
const DOUBLE_CLICK_S: f64 = 0.5;
/// Least time from one frame to the next, seconds.
const LEAST_STEP_S: f64 = 1e-3;

/// Holds back the events that belong to later frames.
#[derive(Debug, Default)]
pub(crate) struct EventOrder {
    waiting: Vec<Event>,
    /// When each of those that wait arrived, seconds.
    arrived_s: Vec<f64>,
    /// The time of the frame before, seconds.
    frame_s: f64,
    at: Option<Pos2>,
}

impl EventOrder {
    /// Puts the events of windows of this context in order, and lets a press that is held for long in a slow frame count
    /// as a click.
    pub(crate) fn install(ctx: &Context) {
        ctx.add_plugin(Self::default());
        ctx.options_mut(|options| {
            options.input_options.max_click_duration = f64::INFINITY;
            options.input_options.max_double_click_delay = DOUBLE_CLICK_S;
        });
    }

    /// Takes the events of the next frame out of those that wait.
    fn next(&mut self, arrived: Vec<Event>, now_s: f64) -> Vec<Event> {
        self.arrived_s.resize(self.waiting.len() + arrived.len(), now_s);
        self.waiting.extend(arrived);
        let mut last = None;
        let mut end = self.waiting.len();
        for (index, event) in self.waiting.iter().enumerate() {
            if last.is_some_and(|last| disturbs(last, event, self.at)) {
                end = index;
                break;
            }
            match event {
                Event::PointerButton { pos, pressed, .. } => {
                    (last, self.at) = (Some(if *pressed { Deed::Press } else { Deed::Release }), Some(*pos));
                }
                Event::MouseWheel { .. } => last = Some(Deed::Wheel),
                Event::Key { key: Key::Tab, pressed: true, .. } => last = Some(Deed::Tab),
                Event::Text(_) | Event::Paste(_) => last = Some(Deed::Text),
                Event::PointerMoved(pos) => self.at = Some(*pos),
                _ => {}
            }
        }
        let first_s = self.arrived_s.first().copied().unwrap_or(now_s);
        self.frame_s = first_s.max(self.frame_s + LEAST_STEP_S).min(now_s.max(self.frame_s));
        self.arrived_s.drain(..end);
        let later = self.waiting.split_off(end);
        std::mem::replace(&mut self.waiting, later)
    }
}

/// What the hand did last.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Deed {
    Press,
    Release,
    Wheel,
    Text,
    /// To the next field.
    Tab,
}

/// Whether `event` in the same frame would change where or how the last deed counts; the pointer is at `at`.
fn disturbs(last: Deed, event: &Event, at: Option<Pos2>) -> bool {
    match event {
        // Words stay in the field in which they are typed.
        Event::Key { key: Key::Tab, pressed: true, .. } if last == Deed::Text => true,
        Event::PointerButton { pressed: true, .. } if last == Deed::Text => true,
        Event::Text(_) | Event::Paste(_) | Event::Key { pressed: true, .. } if last == Deed::Tab => true,
        Event::PointerButton { .. } if last == Deed::Tab => true,
        _ if matches!(last, Deed::Text | Deed::Tab) => false,
        Event::PointerMoved(pos) => at != Some(*pos),
        Event::PointerButton { pos, pressed, .. } => *pressed || last != Deed::Press || at != Some(*pos),
        Event::MouseWheel { .. } => last != Deed::Wheel,
        Event::PointerGone | Event::Key { .. } | Event::Text(_) | Event::ModifiersChanged(_) => true,
        _ => false,
    }
}

impl Plugin for EventOrder {
    fn debug_name(&self) -> &'static str {
        "event order"
    }

    fn input_hook(&mut self, _ctx: &Context, input: &mut RawInput) {
        let arrived = std::mem::take(&mut input.events);
        input.events = self.next(arrived, input.time.unwrap_or(self.frame_s));
        input.time = input.time.map(|_| self.frame_s);
    }

    fn on_end_pass(&mut self, ui: &mut Ui) {
        if !self.waiting.is_empty() {
            ui.ctx().request_repaint();
        }
    }
}

/// The lines that the wheel was turned in this frame, upwards positive: a notch is a line. Nothing while it zooms.
pub(crate) fn wheel_lines(ui: &Ui) -> f32 {
    ui.input(|input| {
        let lines = |event: &Event| match event {
            Event::MouseWheel { unit, delta, modifiers, .. } if !modifiers.command && !modifiers.ctrl => match unit {
                MouseWheelUnit::Line => delta.y,
                MouseWheelUnit::Point => delta.y / LINE,
                MouseWheelUnit::Page => delta.y * PAGE,
            },
            _ => 0.0,
        };
        input.events.iter().map(lines).sum()
    })
}

/// The places to which the pointer was moved in this frame, in order.
pub(crate) fn moves(ui: &Ui) -> Vec<Pos2> {
    let place = |event: &Event| match event {
        Event::PointerMoved(at) => Some(*at),
        _ => None,
    };
    ui.input(|input| input.events.iter().filter_map(place).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui::{Modifiers, PointerButton, pos2};

    fn button(x: f32, pressed: bool) -> Event {
        let modifiers = Modifiers::default();
        Event::PointerButton { pos: pos2(x, 0.0), button: PointerButton::Primary, pressed, modifiers }
    }

    fn moved(x: f32) -> Event {
        Event::PointerMoved(pos2(x, 0.0))
    }

    /// Lengths of the frames into which events are put.
    fn frames(events: Vec<Event>) -> Vec<usize> {
        let mut order = EventOrder::default();
        let mut counts = vec![order.next(events, 1.0).len()];
        while !order.waiting.is_empty() {
            counts.push(order.next(Vec::new(), 1.0).len());
        }
        counts
    }

    #[test]
    fn a_frame_ends_with_a_click_where_something_follows() {
        let click = [moved(1.0), button(1.0, true), button(1.0, false)];
        assert_eq!(frames(click.to_vec()), [3]);
        assert_eq!(frames([&click[..], &[moved(9.0), moved(10.0)]].concat()), [3, 2]);
        // Two clicks at one place count as two, and a key after a click comes after it.
        assert_eq!(frames([&click[..], &click[..]].concat()), [4, 2]);
        let key = Event::ModifiersChanged(Modifiers::SHIFT);
        assert_eq!(frames([std::slice::from_ref(&key), &click[..], std::slice::from_ref(&key)].concat()), [4, 1]);
    }

    #[test]
    fn clicks_in_slow_frames_have_the_times_at_which_they_arrived() {
        let mut order = EventOrder::default();
        let click = [button(1.0, true), button(1.0, false)];
        let mut times = Vec::new();
        for (now_s, arrived) in [(7.0, [&click[..], &click[..]].concat()), (9.0, Vec::new()), (9.1, click.to_vec())] {
            order.next(arrived, now_s);
            times.push(order.frame_s);
        }
        // The second click waited for a frame of two seconds; what arrives later has its own time.
        assert!(times[0] == 7.0 && (7.0..7.01).contains(&times[1]) && times[2] == 9.1, "{times:?}");
        assert!(order.waiting.is_empty() && order.arrived_s.is_empty());
    }

    #[test]
    fn words_stay_on_their_side_of_a_tab_and_of_a_click() {
        let text = |words: &str| Event::Text(words.to_owned());
        let tab = |pressed| Event::Key {
            key: Key::Tab,
            physical_key: None,
            pressed,
            repeat: false,
            modifiers: Modifiers::default(),
        };
        assert_eq!(frames(vec![text("1"), text("2"), tab(true), tab(false), text("3")]), [2, 2, 1]);
        assert_eq!(frames(vec![tab(true), tab(false), tab(true), moved(1.0)]), [2, 2]);
        assert_eq!(frames(vec![text("1"), moved(1.0), button(1.0, true), button(1.0, false), text("2")]), [2, 2, 1]);
    }

    #[test]
    fn a_drag_begins_where_it_was_begun_and_the_wheel_turns_where_the_pointer_was() {
        assert_eq!(frames(vec![moved(1.0), button(1.0, true), moved(5.0), moved(9.0), button(9.0, false)]), [2, 3]);
        let wheel = Event::MouseWheel {
            unit: MouseWheelUnit::Line,
            delta: eframe::egui::vec2(0.0, 1.0),
            phase: eframe::egui::TouchPhase::Move,
            source: eframe::egui::MouseWheelSource::Wheel,
            modifiers: Modifiers::default(),
        };
        assert_eq!(frames(vec![moved(1.0), wheel.clone(), wheel, moved(5.0)]), [3, 1]);
    }
}
