"""What is drawn over the 3D Views; nothing of the scene is changed."""
