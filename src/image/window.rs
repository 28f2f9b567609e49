use super::Plane;
use crate::geometry::{Window, WindowError};

impl Window {
    /// Returns the window, in px, that covers all of an image; see [`Window::of_image`].
    ///
    /// # Errors
    /// Fails if the image has no pixels.
    pub fn of(image: &Plane) -> Result<Self, WindowError> {
        let (height, width) = image.dim();
        Self::of_image(width, height)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_window_of_an_image_is_as_wide_as_its_rows_are_long() {
        let window = Window::of(&Plane::zeros((3, 5))).unwrap();
        assert_eq!(window, Window::of_image(5, 3).unwrap());
        assert!(Window::of(&Plane::zeros((0, 5))).is_err());
    }
}
